/* A stand-in for the vendor's libHD.so that checks the order of calls. The scheduler runs when the test says so, or,
 * with FAKE_HD_SCHEDULER in the environment, in a thread at 1 kHz as the real one does; FAKE_HD_SCHEDULER=N then lets
 * the device fail (communication error) after N frames, N being positive. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fake_hd.h"

struct error_info {
  unsigned int code;
  int internal_code;
  unsigned int handle;
};

enum { HANDLE = 7 };

static struct fake_hd_state state;
static int initialized, enabled, scheduled, running, in_frame;
static unsigned int errors[16];
static int error_count;
static unsigned int next_error, init_error;
static unsigned int (*callback)(void*);
static void* callback_data;
static pthread_t thread;
static int threaded, fail_after;

static void append(char* text, const char* word) {
  if (strlen(text) + strlen(word) + 2 < 512) {
    strcat(text, word);
    strcat(text, " ");
  }
}
static void require(int good, const char* what) {
  if (!good) append(state.violations, what);
}
static void push_error(unsigned int code) {
  if (error_count < 16) errors[error_count++] = code;
}

struct fake_hd_state* fake_hd_reset(void) {
  memset(&state, 0, sizeof state);
  state.transform[0] = state.transform[5] = state.transform[10] = state.transform[15] = 1;
  state.output_freedom = 6;
  error_count = 0;
  next_error = init_error = 0;
  return &state;
}
void fake_hd_error(unsigned int code) {
  next_error = code;
}
void fake_hd_fail_init(unsigned int code) {
  init_error = code;
}
void fake_hd_run(int frames) {
  for (int i = 0; i < frames && running; ++i)
    if (callback(callback_data) != 1) require(0, "callback-did-not-continue");
}

static void* schedule_thread(void* unused) {
  while (running) {
    fake_hd_run(1);
    if (fail_after > 0 && state.frames >= fail_after) next_error = 0x302;
    const struct timespec millisecond = {0, 1000000};
    nanosleep(&millisecond, NULL);
  }
  return unused;
}

unsigned int hdInitDevice(const char* name) {
  if (state.output_freedom == 0) fake_hd_reset();
  append(state.calls, "init");
  if (name != NULL && strcmp(name, "Left") != 0) push_error(0x301);
  if (init_error != 0) push_error(init_error);
  if (error_count > 0) return 0xFFFFFFFF;
  initialized = 1;
  return HANDLE;
}
void hdMakeCurrentDevice(unsigned int handle) {
  require(initialized && handle == HANDLE, "make-current-bad-handle");
}
void hdDisableDevice(unsigned int handle) {
  append(state.calls, "disable");
  require(initialized && handle == HANDLE, "disable-bad-handle");
  require(!running && !scheduled, "disable-while-scheduled");
  initialized = enabled = 0;
}
void hdEnable(unsigned int what) {
  append(state.calls, "enable");
  require(initialized && !running, "enable-out-of-order");
  enabled = what == 0x4000;
}
unsigned long hdScheduleAsynchronous(unsigned int (*function)(void*), void* data, unsigned short priority) {
  append(state.calls, "schedule");
  require(enabled && !running && priority > 0, "schedule-out-of-order");
  callback = function;
  callback_data = data;
  scheduled = 1;
  return 99;
}
void hdStartScheduler(void) {
  append(state.calls, "start");
  require(scheduled, "start-out-of-order");
  running = 1;
  const char* wanted = getenv("FAKE_HD_SCHEDULER");
  threaded = wanted != NULL;
  fail_after = threaded ? atoi(wanted) : 0;
  if (threaded) pthread_create(&thread, NULL, schedule_thread, NULL);
}
void hdStopScheduler(void) {
  append(state.calls, "stop");
  require(running, "stop-out-of-order");
  running = 0;
  if (threaded) pthread_join(thread, NULL);
}
void hdUnschedule(unsigned long handle) {
  append(state.calls, "unschedule");
  require(scheduled && !running && handle == 99, "unschedule-out-of-order");
  scheduled = 0;
}
void hdBeginFrame(unsigned int handle) {
  require(running && !in_frame && handle == HANDLE, "begin-out-of-order");
  in_frame = 1;
  state.torque_was_set = 0;
}
void hdEndFrame(unsigned int handle) {
  require(in_frame && handle == HANDLE, "end-out-of-order");
  in_frame = 0;
  ++state.frames;
  if (next_error != 0) push_error(next_error);
  next_error = 0;
}
void hdGetIntegerv(unsigned int what, int* out) {
  require(initialized, "get-without-device");
  if (what == 0x2000) {
    require(in_frame, "buttons-outside-frame");
    *out = state.buttons;
  } else if (what == 0x2553) {
    *out = 6;
  } else if (what == 0x2554) {
    *out = state.output_freedom;
  } else {
    push_error(0x100);
  }
}
void hdGetDoublev(unsigned int what, double* out) {
  require(initialized, "get-without-device");
  if (what == 0x2052) {
    require(in_frame, "transform-outside-frame");
    memcpy(out, state.transform, sizeof state.transform);
  } else if (what == 0x2603) {
    *out = 8.5;
  } else if (what == 0x2604) {
    *out = 1.4;
  } else {
    push_error(0x100);
  }
}
void hdSetDoublev(unsigned int what, const double* in) {
  require(in_frame && enabled, "set-outside-frame");
  if (what == 0x2700) {
    memcpy(state.force, in, sizeof state.force);
  } else if (what == 0x2701) {
    memcpy(state.torque, in, sizeof state.torque);
    state.torque_was_set = 1;
  } else {
    push_error(0x100);
  }
}
const char* hdGetString(unsigned int what) {
  return what == 0x2501 ? "Stand-in Premium" : NULL;
}
struct error_info hdGetError(void) {
  struct error_info info = {0, 0, HANDLE};
  if (error_count > 0) info.code = errors[--error_count];
  return info;
}
#ifndef FAKE_HD_LACKS_A_FUNCTION
const char* hdGetErrorString(unsigned int code) {
  return code == 0x300 ? "device fault" : "some error";
}
#endif
