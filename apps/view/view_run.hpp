#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "tegotae/session/session.hpp"
#include "view/address.hpp"
#include "view/script_review.hpp"

namespace tegotae::view {

class Server;

/// run_session with a page to look at it. The run goes on after its script, until `stop` (which must be
/// `settings.stop`) or for `settings.seconds`; the page may begin it anew, and change its parts while it runs. A scene
/// that holds no part is shown, and run when the page holds one.
/// `announce` gets the server, whose address is to be opened, and returns whether the run is to wait for the first page
/// (half a minute at most). `review` makes reports on what the mouse did (LiveView). Returns the summary of the last
/// run, nothing when there was none; `file` becomes the scene with which that one began.
std::optional<RunSummary> run_viewed(SceneFile& file, RunSettings settings, const Address& address,
                                     std::atomic<bool>& stop, const std::function<bool(const Server&)>& announce,
                                     const ScriptReview& review = {});

}  // namespace tegotae::view
