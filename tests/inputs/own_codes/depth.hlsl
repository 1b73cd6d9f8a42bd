float EncodeDepth(float viewDepth, float zNear, float zFar)
{
    float d = max(viewDepth, zNear);
    return (d - zNear) * zFar / (d * (zFar - zNear));
}

float DecodeDepth(float number, float zNear, float zFar)
{
    return zNear * zFar / (zNear + (1.0 - number) * (zFar - zNear));
}
