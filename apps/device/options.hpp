#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tegotae::apps {

struct DeviceOptions {
  std::string type;
  std::string script;
  std::string pen;
  std::string name = "tegotae-pen";
  double rate_hz = 1000;
  int cpu = -1;
  bool enforce = false;
  int clutch_button = -1;    ///< none
  int dead_man_button = -1;  ///< none
  bool status = false;
  bool json = false;
};

void add_device_options(CLI::App& app, DeviceOptions& options);

}  // namespace tegotae::apps
