//! Scenes, cameras, shading and pictures of F(x, y, z) = C.
