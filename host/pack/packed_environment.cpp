#include "pack/packed_environment.h"

#include "scene/environment_table.h"

#include "shared/scene_records.h"

#include <algorithm>

namespace isolux {

double brightestTexel(const EnvironmentMap& map) {
    float brightest = 0.0f;
    for (const Vec3f& texel : map.texels) brightest = std::max(brightest, maxComponent(texel));
    return brightest;
}

PackedEnvironment appendEnvironment(Tables& tables, const EnvironmentMap& map, double texelScale) {
    const EnvironmentTable table = buildEnvironmentTable(map);
    PackedEnvironment packed{tables.next(), 0, table.cells.bits, map.width, map.height, texelScale};
    std::size_t texel = 0;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        const double solidAngle = cellSolidAngle(map, row);
        for (std::uint32_t column = 0; column < map.width; ++column, ++texel) {
            const double chosen = table.cells.pdf.empty() ? 0.0 : table.cells.pdf[texel];
            const Vec3f scaled(Vec3d(map.texels[texel]) * texelScale);
            tables.append(glm::vec4(scaled, static_cast<float>(chosen / solidAngle)));
        }
    }
    packed.bins = tables.next();
    for (const AliasTable::Bin& bin : table.cells.bins)
        tables.append(shared::LightBinRecord{{bin.threshold, bin.alias, 0, 0}});
    return packed;
}

} // namespace isolux
