#pragma once

/// The main header: a scene, a pen, the Rig that connects them, and what they need. Everything else has a header of its
/// own (docs/api.md has a map by task).

#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/session/rig.hpp"
