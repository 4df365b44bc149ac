#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "view/frame_ring.hpp"

namespace tegotae::view {

/// What a server shows. Called from the server's threads, several at a time.
class ViewSource {
 public:
  virtual ~ViewSource() = default;
  /// The bundle (bundle.hpp) that the page begins with.
  virtual std::shared_ptr<const std::string> scene() const = 0;
  /// JSON: what changes of about.parts, about.center and about.generation when the scene does; empty: nothing does.
  virtual std::string parts() const { return {}; }
  /// Frames to stream; null when all is in the bundle.
  virtual const FrameRing* frames() const = 0;
  /// JSON that goes along with the frames.
  virtual std::string status() const = 0;
  /// Obeys a command of the page. Throws Error when it cannot.
  virtual void command(const nlohmann::json& command) = 0;
  /// The report (HTML) on the recording that is shown, or on a run by `script` (a stylus script, CSV) where one goes
  /// on; empty when there is none. May take seconds. Throws Error.
  virtual std::string review(const std::string& script) = 0;
};

}  // namespace tegotae::view
