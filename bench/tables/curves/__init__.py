"""The accuracy of stored roughness, metallic, ambient occlusion and colour channels."""
