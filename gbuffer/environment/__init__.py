"""What lies around a scene at every distance: pictures of it, and what surfaces of each roughness see there."""
