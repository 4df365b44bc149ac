#include "shared/guarded_main.hpp"

#include <csignal>
#include <exception>
#include <iostream>
#include <string>

#include "shared/option_check.hpp"
#include "shared/process.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"

namespace tegotae::apps {

namespace {

// The one thing that a signal handler may touch.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) {
  interrupted.store(true);
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void add_version(CLI::App& app) {
  app.set_version_flag("--version", "tegotae " TEGOTAE_VERSION_STRING);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) add_version(*command);
}

int guarded_body(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  add_version(app);
  try {
    app.parse(argc, argv);
    return body();
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::cerr << app.get_name() << ": " << first_line(usage_error(app, argc, argv, e)) << " (see --help)\n";
    return kBadInput;
  } catch (const Error& e) {
    std::cerr << app.get_name() << ": " << e.what() << "\n";
    return kBadInput;
  } catch (const std::exception& e) {
    std::cerr << app.get_name() << ": the run failed: " << first_line(e.what()) << "\n";
    return kRunFailed;
  }
}

}  // namespace

std::atomic<bool>& catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
  return interrupted;
}

int guarded_main(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  prepare_process();
  return finish_output(app.get_name(), guarded_body(app, argc, argv, body));
}

}  // namespace tegotae::apps
