#pragma once

#include <string>

namespace tegotae {

/// The part of OpenHaptics' HDAPI in use, with its types and numbers, so that no SDK is needed to build. Units: mm,
/// rad, N, mN·m. Device axes: x right, y up, z toward the user.
struct HdApi {
  using Handle = unsigned int;
  using Enum = unsigned int;
  using Callback = unsigned int (*)(void*);
  struct ErrorInfo {
    unsigned int code;
    int internal_code;
    Handle handle;
  };

  static constexpr Handle kInvalidHandle = 0xFFFFFFFF;
  static constexpr unsigned int kCallbackContinue = 1;
  static constexpr unsigned short kDefaultPriority = 0xFFFF / 2;
  static constexpr Enum kForceOutput = 0x4000;
  static constexpr Enum kCurrentButtons = 0x2000;    // int
  static constexpr Enum kCurrentTransform = 0x2052;  // 16 doubles, column-major
  static constexpr Enum kModelType = 0x2501;         // string
  static constexpr Enum kInputFreedom = 0x2553;      // int
  static constexpr Enum kOutputFreedom = 0x2554;     // int
  static constexpr Enum kMaxForce = 0x2603;          // double, N
  static constexpr Enum kContinuousForce = 0x2604;   // double, N
  static constexpr Enum kCurrentForce = 0x2700;      // 3 doubles, N
  static constexpr Enum kCurrentTorque = 0x2701;     // 3 doubles, mN·m

  // Errors.
  static constexpr unsigned int kSuccess = 0;
  static constexpr unsigned int kWarmMotors = 0x200;
  static constexpr unsigned int kExceededForce = 0x201;
  static constexpr unsigned int kExceededImpulse = 0x202;
  static constexpr unsigned int kExceededVelocity = 0x203;
  static constexpr unsigned int kForceError = 0x204;
  static constexpr unsigned int kCommError = 0x302;
  static constexpr unsigned int kCommConfigError = 0x303;

  /// Loads `library` and finds every function. It stays loaded: the vendor's threads live in it. Throws Error naming
  /// the library or the function that is missing.
  explicit HdApi(const std::string& library);

  Handle (*init_device)(const char* name);
  void (*disable_device)(Handle);
  void (*make_current_device)(Handle);
  void (*enable)(Enum);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  void (*get_integers)(Enum, int*);
  void (*get_doubles)(Enum, double*);
  void (*set_doubles)(Enum, const double*);
  const char* (*get_string)(Enum);
  ErrorInfo (*get_error)();
  const char* (*error_string)(unsigned int);
  unsigned long (*schedule_asynchronous)(Callback, void*, unsigned short priority);
  void (*unschedule)(unsigned long);
  void (*start_scheduler)();
  void (*stop_scheduler)();
};

}  // namespace tegotae
