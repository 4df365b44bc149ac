#pragma once

#include <string>

namespace tegotae::apps {

/// Opens `url` in the desktop's browser, by xdg-open, in a session of its own: Ctrl-C does not reach it. False where
/// there is no desktop (neither DISPLAY nor WAYLAND_DISPLAY is set) or no xdg-open; whether a browser then appears is
/// not known.
bool open_in_browser(const std::string& url);

}  // namespace tegotae::apps
