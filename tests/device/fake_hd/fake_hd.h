/* Controls of the stand-in for the vendor's libHD.so. */
#pragma once
#ifdef __cplusplus
extern "C" {
#endif
struct fake_hd_state {
  double transform[16]; /* what the device tells: column-major, mm */
  int buttons;
  int output_freedom;
  double force[3];  /* what was rendered in the last frame: N */
  double torque[3]; /* mN*m; only when it was set in that frame */
  int torque_was_set;
  int frames;
  char calls[512];      /* names of the calls outside frames, in order, each followed by a space */
  char violations[512]; /* calls out of order; empty when there was none */
};
typedef struct fake_hd_state* fake_hd_state_function(void);
typedef void fake_hd_run_function(int frames);
typedef void fake_hd_error_function(unsigned int code);

struct fake_hd_state* fake_hd_reset(void);
void fake_hd_run(int frames);              /* calls the scheduled callback, as the scheduler does */
void fake_hd_error(unsigned int code);     /* the next frame ends with this error */
void fake_hd_fail_init(unsigned int code); /* hdInitDevice fails with this error; 0: succeeds */
#ifdef __cplusplus
}
#endif
