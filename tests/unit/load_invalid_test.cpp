// Every malformed file of the shared collection: refused, or rendered with a warning, and why.
//
// What touches geometry, memory, references or required features is refused, naming file and JSON pointer; where a file
// is damaged before there is any JSON to point into, the message begins with what is wrong. What cannot touch the
// picture is warned of. What nothing reads may pass in silence.
#include "unit/load_shared.h"

#include "core/error.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <map>

namespace isolux {
namespace {

enum class Outcome { refused, warned, silent };

struct Choice {
    Outcome outcome;
    std::string message; ///< begins the error after the file's name, or is part of a warning
    std::string reason;
};

using Choices = std::map<std::string, Choice>; // by folder

Choices damagedFiles() {
    using enum Outcome;
    return {
        {"magnum-plugins_error", {refused, "/asset: must be an object", "structure: no glTF"}},
        {"synthetic_glb_chunk_longer_than_file", {refused, "a GLB chunk claims 2147483647 bytes", "memory"}},
        {"tinygltf_zero-sized-bin-chunk-issue-440", {silent, "", "valid: an empty second chunk, and data in a URI"}},
        {"validator_glb_chunk_too_big", {refused, "1 stray bytes where a GLB chunk", "memory: chunks leave the file"}},
        {"validator_glb_two_empty_json_chunks",
         {refused, "the GLB has two JSON chunks", "structure: which one counts?"}},
        {"validator_glb_zero_length", {refused, "the GLB header claims 0 bytes", "memory"}},
        {"validator_json_empty_file", {refused, "the file is empty", "structure: no glTF"}},
        {"validator_json_invalid_object", {refused, "must be an object, not array", "structure: no glTF"}},
        {"magnum-plugins_version-unsupported", {refused, "/asset/version: glTF 3.0", "required features"}},
        {"tinygltf_issue-416", {refused, "/asset/version: '' is not a version", "required features: unknown"}},
        {"validator_asset_invalid_version", {refused, "/asset/version: '1.0.1-dev'", "required features: unknown"}},
        {"validator_asset_min_version_invalid",
         {refused, "/asset/minVersion: a reader of glTF 2.1", "required features"}},
    };
}

Choices damagedBuffers() {
    using enum Outcome;
    return {
        {"assimp_Cube", {refused, "/bufferViews/2: its 432 bytes from byte 504 on do not fit", "memory"}},
        {"magnum-plugins_buffer-invalid-short-size", {refused, "/buffers/0/byteLength: is 24 but", "memory"}},
        {"magnum-plugins_mesh-invalid", {refused, "/bufferViews/2: its 40 bytes from byte 29 on", "memory"}},
        {"synthetic_bufferview_offset_int64max", {refused, "/bufferViews/0: its 36 bytes from byte", "memory"}},
        {"synthetic_huge_accessor_count", {refused, "/accessors/0: its 4294967295 elements", "memory"}},
        {"tinygltf_integer-out-of-bounds", {refused, "/bufferViews/0/byteLength: must be a non-negative", "memory"}},
        {"tinygltf_invalid-buffer-index", {refused, "/bufferViews/1/buffer: refers to buffers 1", "reference"}},
        {"tinygltf_invalid-buffer-view-index", {refused, "/bufferViews/0/buffer: refers to buffers 0", "reference"}},
        {"validator_accessor_data_out_of_range_elements_uint16",
         {silent, "", "min and max are never read: bounds come from the elements"}},
        {"validator_accessor_invalid_sparse_count_and_stride",
         {refused, "/accessors/0/sparse/count: is 2 but must lie in [1, 1]", "geometry"}},
        {"validator_accessor_matrix_alignment", {refused, "/accessors/0: its 2 elements of 8 bytes", "memory"}},
        {"validator_animation_sampler_bufferview_bytestride",
         {refused, "/buffers/0: has no uri, and there is no binary chunk", "memory: the buffer has no bytes"}},
        {"validator_buffer_invalid_uri_data_bytelength", {refused, "/buffers/0/byteLength: is 2 but", "memory"}},
        {"validator_buffer_invalid_uri_data_mime",
         {warned, "/buffers/0/uri: its media type application/octet-stream2 is not that of a buffer",
          "bytes have one meaning only"}},
        {"validator_buffer_no_bin_chunk", {refused, "/buffers/0: has no uri, and there is no binary chunk", "memory"}},
        {"validator_buffer_view_zero_bytelength", {refused, "/bufferViews/0/byteLength: is 0 but", "memory"}},
        {"validator_mesh_data_joints_no_weights", {refused, "/bufferViews/0: its 32 bytes from byte 0 on", "memory"}},
    };
}

Choices damagedMeshes() {
    using enum Outcome;
    return {
        {"assimp_AllIndicesOutOfRange", {refused, "/accessors/0: element 0 is 65535", "geometry"}},
        {"assimp_BoxBadNormals",
         {warned, "/meshes/0/primitives/0: normals that are not of length 1",
          "a normal is a direction: its length is divided out, and without one the face's own takes its place"}},
        {"assimp_BoxWithInfinites", {refused, "/accessors/2: element 0 is not finite", "geometry"}},
        {"assimp_IndexOutOfRange", {refused, "/accessors/0: element 0 is 255, but", "geometry"}},
        {"assimp_badArray", {refused, "/meshes/0/primitives: must be an array", "structure of geometry"}},
        {"synthetic_index_0xffffffff", {refused, "/accessors/1: element 2 is 4294967295", "geometry"}},
        {"synthetic_nan_inf_positions", {refused, "/accessors/0: element 0 is not finite", "geometry"}},
        {"validator_KHR_mesh_quantization_data_primitive_non_required",
         {warned, "/meshes/0/primitives/0: integer vertices without KHR_mesh_quantization in extensionsRequired",
          "integers mean the same without"}},
        {"validator_KHR_mesh_quantization_data_primitive_unexpected_extension",
         {warned, "/accessors/0/extensions: KHR_mesh_quantization has no meaning here", "nothing reads it"}},
        {"validator_KHR_texture_transform_data_textureInfo_uv_sets",
         {warned, "/meshes/0/primitives/0: it has no TEXCOORD_2", "the maps have no image to show either"}},
        {"validator_mesh_data_normals_tangents_non_unit_invalid_sign",
         {silent, "", "no node places the mesh, so that no element is read"}},
        {"validator_mesh_empty_object", {refused, "/meshes/0/primitives: is missing", "structure of geometry"}},
        {"validator_mesh_morph_attribute_invalid_count",
         {refused, "/meshes/0/primitives/0/targets/0/POSITION: has 4 elements but", "geometry"}},
    };
}

Choices damagedNodes() {
    using enum Outcome;
    return {
        {"assimp_RecursiveNodes", {refused, "/nodes/1/children/0: node 0 is its own ancestor", "reference"}},
        {"assimp_SceneWithoutNodes", {warned, "the scene has nothing to render", "valid: an empty scene"}},
        {"magnum-plugins_camera-invalid", {refused, "/cameras/0/type: must be perspective", "what is seen"}},
        {"magnum-plugins_scene-default-oob", {refused, "/scene: refers to scenes 0", "reference"}},
        {"magnum-plugins_scene-invalid-cycle", {refused, "/nodes/0/children/0: node 0 is its own", "reference"}},
        {"magnum-plugins_scene-invalid-cycle-deep", {refused, "/nodes/2/children/0: node 0 is its own", "reference"}},
        {"magnum-plugins_scene-invalid-multiple-parents",
         {refused, "/nodes/1/children/0: node 2 already has a parent", "reference"}},
        {"synthetic_camera_zero_fov", {refused, "/cameras/0/perspective/yfov: is 0", "what is seen"}},
        {"synthetic_light_index_oob",
         {refused, "/extensions/KHR_lights_punctual/lights/0/intensity: is -5", "what is seen, and a reference"}},
        {"synthetic_two_node_cycle", {refused, "/nodes/1/children/0: node 0 is its own ancestor", "reference"}},
        {"synthetic_zero_scale_node", {silent, "", "valid: the usual way of hiding a node"}},
        {"tinygltf_issue-492", {warned, "the scene has nothing to render", "valid: a skeleton without a mesh"}},
        {"validator_KHR_lights_punctual_data_light_empty_light_object",
         {refused, "/extensions/KHR_lights_punctual/lights/0/type: is missing", "what is seen"}},
        {"validator_KHR_lights_punctual_data_light_spot_invalid_angles",
         {refused, "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle: is 0.2", "what is seen"}},
        {"validator_camera_orthographic_xy", {refused, "/cameras/0/orthographic/ymag: is 0", "what is seen"}},
        {"validator_camera_orthographic_z",
         {warned, "/cameras/0/orthographic: znear or zfar is missing or invalid", "neither clips"}},
        {"validator_camera_perspective_z",
         {warned, "/cameras/0/perspective: znear or zfar is missing or invalid", "neither clips"}},
        {"validator_node_matrix_indecomposable", {refused, "/nodes/0/matrix: is not affine", "geometry"}},
        {"validator_node_node_loop_scene", {refused, "/nodes/5/children/0: node 4 already has a parent", "reference"}},
        {"validator_node_node_weights_invalid",
         {warned, "/meshes/0/primitives/0/targets: morph targets are not supported", "weights are not read"}},
        {"validator_scene_empty_array", {warned, "/scenes: is an empty array", "means the same as none"}},
        {"validator_scene_empty_nodes_array", {warned, "/scenes/0/nodes: is an empty array", "means the same as none"}},
        {"validator_scene_unresolved_node", {refused, "/scenes/0/nodes/0: refers to nodes 0", "reference"}},
    };
}

Choices damagedSurfaces() {
    using enum Outcome;
    return {
        {"assimp_badUint",
         {refused, "/materials/0/pbrMetallicRoughness/baseColorTexture/index: must be a non-negative integer",
          "reference"}},
        {"synthetic_png_header_65535x65535", {refused, "/images/0: it claims 65535 x 65535 texels", "memory"}},
        {"validator_EXT_texture_webp_data_texture_undeclared_extension",
         {warned, "/textures/0/extensions: EXT_texture_webp is not among extensionsUsed", "read all the same"}},
        {"validator_KHR_materials_ior_data_material_out_of_range",
         {refused, "/materials/0/extensions/KHR_materials_ior/ior: is -0.5", "what is seen"}},
        {"validator_KHR_materials_ior_data_material_unexpected_extension",
         {warned, "/materials/0/pbrMetallicRoughness/extensions: KHR_materials_ior has no meaning here",
          "nothing reads it"}},
        {"validator_KHR_materials_volume_data_material_out_of_range",
         {refused, "/materials/0/extensions/KHR_materials_volume/thicknessFactor: is -1", "what is seen"}},
        {"validator_KHR_materials_volume_data_material_unexpected_extension",
         {warned, "/materials/0/pbrMetallicRoughness/extensions: KHR_materials_volume has no meaning here",
          "nothing reads it"}},
        {"validator_KHR_texture_transform_data_textureInfo_unexpected_extension",
         {warned, "/textures/0/extensions: KHR_texture_transform has no meaning here", "nothing reads it"}},
        {"validator_image_empty_object", {refused, "/images/0: must have either a uri or a bufferView", "reference"}},
        {"validator_image_invalid_data_uri_mime_type",
         {warned, "/images/0/uri: its media type image/gif is not image/png", "the bytes say what the image is"}},
        {"validator_image_not_found", {refused, "/images/0/uri: cannot read", "reference"}},
        {"validator_material_unresolved_basecolor",
         {refused, "/materials/0/pbrMetallicRoughness/baseColorTexture/index: refers to textures 0", "reference"}},
        {"validator_material_unresolved_emissive",
         {refused, "/materials/0/emissiveTexture/index: refers to textures 0", "reference"}},
        {"validator_material_unresolved_mr",
         {refused, "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index: refers to", "reference"}},
        {"validator_sampler_empty_array", {warned, "/samplers: is an empty array", "means the same as none"}},
        {"validator_texture_empty_array", {warned, "/textures: is an empty array", "means the same as none"}},
        {"validator_texture_unresolved_sampler", {refused, "/textures/0/sampler: refers to samplers 0", "reference"}},
        {"validator_texture_unresolved_source", {refused, "/textures/0/source: refers to images 0", "reference"}},
    };
}

Choices damagedOthers() {
    using enum Outcome;
    return {
        {"validator_animation_channel_duplicate_targets",
         {warned, "/animations: animations are not supported", "rendered at rest, whatever they do"}},
        {"validator_animation_channel_node_matrix",
         {warned, "/animations: animations are not supported", "rendered at rest, whatever they do"}},
        {"validator_root_duplicate_extension_entry",
         {warned, "/extensionsUsed/1: KHR_materials_unlit is listed twice", "means the same as once"}},
        {"validator_root_extensions_undeclared_wrong_pointer",
         {warned, "/extensions: EXT_undeclared_extension is not among extensionsUsed", "nothing reads it"}},
        {"validator_skin_ibm_invalid_format",
         {warned, "/skins/0/inverseBindMatrices: refers to an accessor that is not MAT4", "skins are not read"}},
        {"validator_skin_unresolved_joint", {refused, "/skins/0/joints/0: refers to nodes 0", "reference"}},
    };
}

Choices allChoices() {
    Choices all;
    for (Choices part :
         {damagedFiles(), damagedBuffers(), damagedMeshes(), damagedNodes(), damagedSurfaces(), damagedOthers()})
        all.merge(part);
    return all;
}

void expectRefused(const fs::path& file, const Choice& choice) {
    try {
        (void)loadScene(file);
        ADD_FAILURE() << file << " is loaded, although its defect touches: " << choice.reason;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput) << error.what();
        const std::string message = error.what();
        EXPECT_EQ(message.find(file.string() + ": " + choice.message), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

void expectLoaded(const fs::path& file, const Choice& choice) {
    const Scene scene = loadScene(file);
    const auto names = [&](const std::string& warning) { return warning.find(choice.message) != std::string::npos; };
    EXPECT_TRUE(choice.outcome == Outcome::silent || std::any_of(scene.warnings.begin(), scene.warnings.end(), names))
        << file << " has no warning of '" << choice.message << "'";
}

TEST(SharedScenes, InvalidScenesAreRefusedOrWarnedOfAsChosen) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const Choices choices = allChoices();
    const auto listed = nlohmann::json::parse(std::ifstream(*folder / "invalid" / "expected.json"));
    std::size_t found = 0;
    for (const fs::path& file : gltfFilesIn(*folder / "invalid")) {
        const auto choice = choices.find(file.parent_path().filename().string());
        ASSERT_NE(choice, choices.end()) << "no choice is made for " << file;
        ++found;
        if (choice->second.outcome == Outcome::refused)
            expectRefused(file, choice->second);
        else
            expectLoaded(file, choice->second);
    }
    EXPECT_EQ(found, choices.size());
    EXPECT_EQ(found, listed.size());
}

} // namespace
} // namespace isolux
