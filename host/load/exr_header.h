// OpenEXR files (Kainz et al. 2013, "OpenEXR File Layout"): what their header claims, held against their bytes.
#pragma once

#include "load/bytes.h"

namespace isolux {

/// That a file is a single image whose header claims no more than `mostTexels`, and no more than its bytes can hold:
/// the library behind OpenImageIO takes memory for whatever a header says. Changes the header so that it reads none of
/// the attributes which are not needed to decode the image, and have lengths of their own inside. Throws Error.
void tameExrHeader(Bytes& exr, double mostTexels, const LoadContext& context);

} // namespace isolux
