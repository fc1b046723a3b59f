#include "load/model.h"

#include "core/error.h"
#include "load/context.h"

#include <fmt/format.h>

#include <limits>

namespace isolux {

tinygltf::Model parseModel(const nlohmann::json& verified, const LoadContext& context) {
    const std::string text = verified.dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) context.fail("", "its JSON is larger than 4 GB");
    tinygltf::TinyGLTF parser;
    parser.RemoveImageLoader();
    parser.SetFsCallbacks({});
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), ""))
        context.fail("", "tinygltf cannot read it: " + printable(error));
    return model;
}

} // namespace isolux
