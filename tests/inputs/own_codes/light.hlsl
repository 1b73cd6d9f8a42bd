static const float Range = 6.0;

float4 EncodeRGBM(float3 light)
{
    float largest = max(max(light.x, light.y), light.z);
    float m = min(max(ceil(largest * (255.0 / Range) - 1.0 / 1024.0), 1.0), 255.0) * (1.0 / 255.0);
    return float4(light * (1.0 / (m * Range)), m);
}

float3 DecodeRGBM(float4 rgbm) { return rgbm.rgb * (rgbm.a * Range); }
