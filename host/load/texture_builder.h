// Gives the scene the textures and images that its materials use.
#pragma once

#include "load/file_texture.h"
#include "load/images.h"

namespace isolux {

/// Adds the textures that the scene's surfaces need, and decodes their images, each once; maps of materials then refer
/// to them. Materials without a surface lose their maps.
void buildTextures(Scene& scene, const std::vector<FileTexture>& textures, const std::vector<EncodedImage>& images);

} // namespace isolux
