// How long-running work reports back and learns that it should stop.
#pragma once

#include <functional>

namespace isolux {

enum class Continue { yes, no };

/// Called with the fraction done in [0, 1], from one thread at a time. Returning `Continue::no` asks the work to stop
/// at the next point where what was done so far is whole.
using ProgressCallback = std::function<Continue(double fraction)>;

} // namespace isolux
