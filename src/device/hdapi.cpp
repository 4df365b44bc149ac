#include "device/hdapi.hpp"

#include <dlfcn.h>

#include "tegotae/core/error.hpp"

namespace tegotae {

HdApi::HdApi(const std::string& library) {
  void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    const char* cause = dlerror();
    throw Error(ErrorKind::device,
                "OpenHaptics: " + std::string(cause != nullptr ? cause : library + " cannot be loaded") +
                    "; install the vendor's OpenHaptics runtime, or name its folder in LD_LIBRARY_PATH");
  }
  const auto find = [&](auto& function, const char* name) {
    void* symbol = dlsym(loaded, name);
    if (symbol == nullptr) throw Error(ErrorKind::device, "OpenHaptics: " + library + " has no function " + name);
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
  };
  find(init_device, "hdInitDevice");
  find(disable_device, "hdDisableDevice");
  find(make_current_device, "hdMakeCurrentDevice");
  find(enable, "hdEnable");
  find(begin_frame, "hdBeginFrame");
  find(end_frame, "hdEndFrame");
  find(get_integers, "hdGetIntegerv");
  find(get_doubles, "hdGetDoublev");
  find(set_doubles, "hdSetDoublev");
  find(get_string, "hdGetString");
  find(get_error, "hdGetError");
  find(error_string, "hdGetErrorString");
  find(schedule_asynchronous, "hdScheduleAsynchronous");
  find(unschedule, "hdUnschedule");
  find(start_scheduler, "hdStartScheduler");
  find(stop_scheduler, "hdStopScheduler");
}

}  // namespace tegotae
