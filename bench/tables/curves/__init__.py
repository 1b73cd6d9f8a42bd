"""How exact roughness, metalness, occlusion and the channels of colours are."""
