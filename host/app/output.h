// What a render leaves on disk: images with metadata, and reports.
#pragma once

#include "app/backends.h"
#include "film/film.h"
#include "film/layers.h"
#include "report/run_report.h"

#include <string>
#include <vector>

namespace isolux {

enum class Completion { whole, interrupted, failed };

/// What to write, and where.
struct OutputRequest {
    std::vector<std::string> paths;
    LayerSet layers{Layer::variance, Layer::samples};
    DisplayTransform display; ///< of PNG files
};

/// Writes the film to every path. A render that is not whole replaces a file only if that holds no more samples;
/// otherwise it goes beside it, with ".partial" in its name. One file that cannot be written does not keep the others
/// from being so; the first error is thrown at the end.
void writeOutputs(const OutputRequest& request, const Film& film, const SceneRun& run, const RunReport& report,
                  Completion completion);

/// Throws Error (bad input) early if `path` names a folder or its own folder does not exist.
void checkTextPath(const std::string& path);

/// Makes the folder, and those above it, unless it is there. Throws Error (bad input), which names it, if that fails or
/// nothing can be written there.
void makeFolder(const std::string& folder);

/// Writes a text file to a temporary name, flushed and renamed. Throws Error.
void writeText(const std::string& path, const std::string& text);

} // namespace isolux
