#pragma once

#include <string>
#include <vector>

#include "shared/guarded_main.hpp"

namespace tegotae::apps {

/// The command line of `app`, where a file that was given in the place of a command gets the command `view` before it:
/// a file that was dropped on the program is to be looked at. So does what is named like a file but is not there, for
/// the message. A command wins over a file of its name.
std::vector<char*> with_view(const CLI::App& app, int argc, char** argv);

}  // namespace tegotae::apps
