#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tegotae/loop/scene.hpp"

namespace tegotae::apps {

/// Adds an option for a pose of the held part's file frame as in scene files: X,Y,Z in m, and W,X,Y,Z of a quaternion
/// where the part is to be turned.
CLI::Option* add_pose_option(CLI::App& app, const std::string& name, std::string& text, const std::string& help);

/// The goal of a part that is to come out of all others.
inline constexpr const char* kOut = "out";

/// The same for a goal, which may be kOut as well.
CLI::Option* add_goal_option(CLI::App& app, const std::string& name, std::string& text, const std::string& help);
/// What is wrong with the text of a goal; empty: nothing.
std::string goal_error(const std::string& goal);

/// Reads a pose; without a quaternion the orientation is that in which the scene holds the part.
Pose parse_pose(const std::string& text, const Scene& scene);

}  // namespace tegotae::apps
