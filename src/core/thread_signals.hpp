#pragma once

#include <signal.h>

namespace tegotae {

/// While it lives, writes of this thread that nobody reads (SIGPIPE) or that pass a limit of size (SIGXFSZ) fail with
/// an errno and end no process, whatever its program does about signals. The program's own handling of them stays.
class WriteSignals {
 public:
  WriteSignals() noexcept;
  ~WriteSignals();
  WriteSignals(const WriteSignals&) = delete;
  WriteSignals& operator=(const WriteSignals&) = delete;

 private:
  sigset_t before_;
  sigset_t pending_before_;
};

}  // namespace tegotae
