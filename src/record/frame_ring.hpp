#pragma once

#include "core/ring.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae {

using FrameRing = Ring<RecordFrame>;

}  // namespace tegotae
