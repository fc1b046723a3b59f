// What no part of the renderer reads and a file may have wrong all the same, wherever it stands: extensions that are
// not declared or stand where they have no meaning, and empty arrays. All of it is warned of.
#include "load/context.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace isolux {
namespace {

using nlohmann::json;

/// An extension, and the kinds of object that may have it.
struct Place {
    std::string_view extension;
    std::string_view owner;
};

constexpr std::string_view kTextureInfo = "Texture"; // how members that use a texture are called, at their end

constexpr std::array<Place, 10> kPlaces = {{{"EXT_texture_webp", "textures"},
                                            {"KHR_lights_punctual", ""},
                                            {"KHR_lights_punctual", "nodes"},
                                            {"KHR_materials_emissive_strength", "materials"},
                                            {"KHR_materials_ior", "materials"},
                                            {"KHR_materials_specular", "materials"},
                                            {"KHR_materials_transmission", "materials"},
                                            {"KHR_materials_unlit", "materials"},
                                            {"KHR_materials_volume", "materials"},
                                            {"KHR_texture_transform", kTextureInfo}}};

std::set<std::string_view> namesIn(const json& root, const char* key) {
    std::set<std::string_view> names;
    if (const auto list = root.find(key); list != root.end())
        for (const json& name : *list) names.insert(name.get_ref<const std::string&>()); // verified to be text
    return names;
}

/// Walks the whole document, as deep as it was parsed; extras are the file's own and left out.
class MemberWalk {
public:
    MemberWalk(const json& root, LoadContext& context)
        : context_(context), declared_(namesIn(root, "extensionsUsed")) {}

    void visit(const json& value) {
        if (value.is_array()) visitArray(value);
        if (value.is_object()) visitObject(value);
    }

private:
    void visitArray(const json& array) {
        if (array.empty()) context_.warn(pointer(), "is an empty array, which glTF forbids; ignored");
        for (std::size_t i = 0; i < array.size(); ++i) {
            if (!array[i].is_structured()) continue;
            path_.push_back(std::to_string(i));
            visit(array[i]);
            path_.pop_back();
        }
    }

    void visitObject(const json& object) {
        for (const auto& [key, value] : object.items()) {
            if (!value.is_structured() || key == "extras" || isForeign(key)) continue;
            if (key == "extensions" && value.is_object()) visitExtensions(value);
            path_.push_back(key);
            visit(value);
            path_.pop_back();
        }
    }

    void visitExtensions(const json& extensions) {
        const std::string owner = ownerKind();
        for (const auto& item : extensions.items()) {
            const std::string where = pointer() + "/extensions";
            const std::string name = printable(item.key());
            const bool isKnown = std::any_of(kPlaces.begin(), kPlaces.end(),
                                             [&](const Place& place) { return place.extension == item.key(); });
            if (!declared_.contains(item.key()))
                context_.warn(where, fmt::format("{} is not among extensionsUsed; {}", name,
                                                 isKnown ? "read all the same" : "ignored"));
            else if (isSupportedExtension(item.key()) && !mayStandIn(owner, item.key()))
                context_.warn(where, fmt::format("{} has no meaning here; ignored", name));
        }
    }

    /// The inside of an extension that is not supported has rules of its own.
    [[nodiscard]] bool isForeign(std::string_view key) const {
        return !path_.empty() && path_.back() == "extensions" && !isSupportedExtension(key);
    }

    static bool mayStandIn(std::string_view owner, std::string_view extension) {
        return std::any_of(kPlaces.begin(), kPlaces.end(), [&](const Place& place) {
            return place.extension == extension &&
                   (place.owner == kTextureInfo ? owner.ends_with(kTextureInfo) : owner == place.owner);
        });
    }

    /// What the object at the path is: the array of the root that it is an element of, else the member's name.
    [[nodiscard]] std::string ownerKind() const {
        if (path_.empty()) return "";
        return path_.size() == 2 ? path_.front() : path_.back();
    }

    [[nodiscard]] std::string pointer() const {
        std::string text;
        for (const std::string& key : path_) text += "/" + escapedKey(key);
        return text;
    }

    LoadContext& context_;
    std::set<std::string_view> declared_;
    std::vector<std::string> path_;
};

} // namespace

void warnOfMembers(const json& root, LoadContext& context) { MemberWalk(root, context).visit(root); }

} // namespace isolux
