#pragma once

namespace tegotae {

/// The processors that the process may use, at least 1: those of the machine or fewer, where it is bound to some.
int usable_processors() noexcept;

}  // namespace tegotae
