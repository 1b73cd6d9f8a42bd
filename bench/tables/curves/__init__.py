"""The accuracy of roughness, metallic, ambient occlusion and the channels of colours."""
