fn encode_depth(depth: f32, near: f32, far: f32) -> f32 {
    let d = max(depth, near);
    return (d - near) * far / (d * (far - near));
}

fn decode_depth(w: f32, near: f32, far: f32) -> f32 {
    return near * far / (near + (1.0 - w) * (far - near));
}
