// `isolux devices`: every Vulkan device, what it can do that matters here, and why one cannot be used.
#include "app/commands.h"
#include "gpu/device.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace isolux {
namespace {

enum class Format { text, json };

void printText(const std::vector<DeviceDescription>& devices) {
    for (const DeviceDescription& device : devices) {
        fmt::print("{}  {}, {}, Vulkan {}\n", device.index, device.name, device.type, device.apiVersion);
        fmt::print("   driver     {} {}\n", device.driverName, device.driverVersion);
        if (!device.unusable.empty()) {
            fmt::print("   unusable   {}\n", device.unusable);
            continue;
        }
        fmt::print("   buffers    storage up to {} MiB, texel up to {} texels\n",
                   device.limits.maxStorageBufferRange >> 20, device.limits.maxTexelBufferElements);
        fmt::print("   workgroups up to {} lanes, subgroups of {}\n", device.limits.maxWorkgroupSize,
                   device.limits.subgroupSize);
        fmt::print("   timestamps {}\n", device.limits.secondsPerTimestamp > 0.0
                                             ? fmt::format("every {:.3g} ns", device.limits.secondsPerTimestamp * 1e9)
                                             : "none: the host's clock is used");
    }
}

nlohmann::ordered_json toJson(const DeviceDescription& device) {
    return {{"index", device.index},
            {"name", device.name},
            {"type", device.type},
            {"apiVersion", device.apiVersion},
            {"driverName", device.driverName},
            {"driverVersion", device.driverVersion},
            {"usable", device.unusable.empty()},
            {"unusable", device.unusable},
            {"maxStorageBufferRange", device.limits.maxStorageBufferRange},
            {"maxTexelBufferElements", device.limits.maxTexelBufferElements},
            {"maxWorkgroupSize", device.limits.maxWorkgroupSize},
            {"subgroupSize", device.limits.subgroupSize},
            {"secondsPerTimestamp", device.limits.secondsPerTimestamp}};
}

ExitCode run(Format format) {
    const std::vector<DeviceDescription> devices = listDevices();
    if (format == Format::json) {
        nlohmann::ordered_json json{{"schema", 1}, {"devices", nlohmann::ordered_json::array()}};
        for (const DeviceDescription& device : devices) json["devices"].push_back(toJson(device));
        fmt::print("{}\n", json.dump(2));
    } else {
        printText(devices);
    }
    const bool anyUsable =
        std::any_of(devices.begin(), devices.end(), [](const DeviceDescription& d) { return d.unusable.empty(); });
    return anyUsable ? ExitCode::success : ExitCode::failure;
}

} // namespace

void addDevicesCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("devices", "List the Vulkan devices and what they can do");
    auto json = std::make_shared<bool>(false);
    sub->add_flag("--json", *json, "Print JSON");
    sub->footer("Exit code 1 if no device can be used.\n"
                "VK_DRIVER_FILES (older loaders: VK_ICD_FILENAMES) names the drivers to load.\n"
                "Examples:\n"
                "  isolux devices\n"
                "  VK_DRIVER_FILES=/path/to/icd.json isolux devices --json");
    sub->callback([json, &result] { result = run(*json ? Format::json : Format::text); });
}

} // namespace isolux
