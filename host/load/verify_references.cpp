// References among parts of the document that are not supported yet: wrong ones are errors all the same.
#include "load/verify_parts.h"

namespace isolux {
namespace {

/// `owner`'s member `key`, if present, is an index into the document's array `target`.
void verifyReference(const JsonReader& owner, std::string_view key, const JsonReader& root, std::string_view target) {
    if (const std::optional<JsonReader> reference = owner.find(key))
        (void)reference->index(root.sizeOf(target), target);
}

void verifyBindMatrices(const JsonReader& skin, const JsonReader& root) {
    const std::optional<JsonReader> matrices = skin.find("inverseBindMatrices");
    if (!matrices) return;
    const JsonReader accessor = matrices->elementOf(root, "accessors");
    if (accessor.at("type").string() != "MAT4" || accessor.at("componentType").integer() != 5126)
        matrices->warn("refers to an accessor that is not MAT4 of single precision; skins are not supported, so that "
                       "nothing reads it");
}

void verifySkins(const JsonReader& root) {
    for (std::size_t i = 0; i < root.sizeOf("skins"); ++i) {
        const JsonReader skin = root.at("skins").element(i);
        verifyBindMatrices(skin, root);
        verifyReference(skin, "skeleton", root, "nodes");
        const JsonReader joints = skin.at("joints");
        for (std::size_t j = 0; j < joints.size(); ++j) (void)joints.element(j).index(root.sizeOf("nodes"), "nodes");
    }
}

void verifyAnimation(const JsonReader& animation, const JsonReader& root) {
    for (std::size_t i = 0; i < animation.sizeOf("channels"); ++i) {
        const JsonReader channel = animation.at("channels").element(i);
        (void)channel.at("sampler").index(animation.sizeOf("samplers"), "samplers of the animation:");
        verifyReference(channel.at("target"), "node", root, "nodes");
    }
    for (std::size_t i = 0; i < animation.sizeOf("samplers"); ++i) {
        verifyReference(animation.at("samplers").element(i), "input", root, "accessors");
        verifyReference(animation.at("samplers").element(i), "output", root, "accessors");
    }
}

void verifyAnimations(const JsonReader& root) {
    const std::size_t count = root.sizeOf("animations");
    for (std::size_t i = 0; i < count; ++i) verifyAnimation(root.at("animations").element(i), root);
    if (count > 0) root.at("animations").warn("animations are not supported; the scene is rendered at rest");
}

} // namespace

void verifyReferences(const JsonReader& root) {
    verifySkins(root);
    verifyAnimations(root);
}

} // namespace isolux
