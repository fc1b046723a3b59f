#include "load/texture_builder.h"

#include "load/context.h"
#include "load/uri.h"

#include <fmt/format.h>

#include <map>

namespace isolux {
namespace {

std::uint64_t bytesOf(const TextureImage& image) {
    return image.texels8.size() * sizeof(Texel8) + image.texels16.size() * sizeof(Texel16);
}

class TextureBuilder {
public:
    TextureBuilder(Scene& scene, const std::vector<FileTexture>& textures, const std::vector<EncodedImage>& images)
        : scene_(scene), textures_(textures), images_(images) {}

    /// The scene's texture for one of the file's.
    std::uint32_t textureFor(std::uint32_t fileTexture) {
        const FileTexture& source = textures_[fileTexture];
        Texture texture = source.sampling;
        texture.image = imageFor(*source.image); // maps without one were left out at verification
        const auto next = static_cast<std::uint32_t>(scene_.textures.size());
        const auto [entry, isNew] =
            textureOf_.emplace(std::tuple(texture.image, texture.wrapU, texture.wrapV, texture.filter), next);
        if (isNew) scene_.textures.push_back(texture);
        return entry->second;
    }

private:
    std::uint32_t imageFor(std::uint32_t fileImage) {
        if (const auto known = imageOf_.find(fileImage); known != imageOf_.end()) return known->second;
        const EncodedImage& encoded = images_[fileImage];
        TextureImage image = decodeImage(encoded, encoded.where.context().limits().texelBytes - texelBytes_);
        image.name = nameOf(encoded.where, fileImage);
        texelBytes_ += bytesOf(image);
        scene_.images.push_back(std::move(image));
        return imageOf_.emplace(fileImage, static_cast<std::uint32_t>(scene_.images.size() - 1)).first->second;
    }

    static std::string nameOf(const JsonReader& image, std::uint32_t index) {
        const std::optional<JsonReader> name = image.find("name");
        const std::optional<JsonReader> uri = image.find("uri");
        if (name && !name->string().empty()) return name->string();
        return uri && !isDataUri(uri->string()) ? uri->string() : fmt::format("image {}", index);
    }

    Scene& scene_;
    const std::vector<FileTexture>& textures_;
    const std::vector<EncodedImage>& images_;
    std::map<std::uint32_t, std::uint32_t> imageOf_;
    std::map<std::tuple<std::uint32_t, TextureWrap, TextureWrap, TextureFilter>, std::uint32_t> textureOf_;
    std::uint64_t texelBytes_ = 0;
};

} // namespace

void buildTextures(Scene& scene, const std::vector<FileTexture>& textures, const std::vector<EncodedImage>& images) {
    TextureBuilder builder(scene, textures, images);
    const std::vector<bool> inUse = materialsInUse(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        for (TextureMap& map : scene.materials[i].maps) {
            if (!inUse[i]) map = {};
            if (map.present()) map.texture = builder.textureFor(map.texture);
        }
}

} // namespace isolux
