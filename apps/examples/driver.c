/* A driver in C for a device of three degrees of freedom, with nothing but shm.h and the C library. The device is made
 * up: it goes 10 mm down and up again every second. A real one would read its encoders and write to its motors in the
 * two functions at the top; everything below them stays. Usage: driver NAME SECONDS */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "tegotae/device/shm.h"

#define PERIOD_NS INT64_C(1000000)   /* 1 kHz */
#define TIMEOUT_NS INT64_C(20000000) /* an older heartbeat of the application means no force */
#define FORCE_LIMIT 3.0              /* N */
#define PI 3.14159265358979323846

static void device_read(double t, double p[3], double v[3]) { /* m and m/s; axes of the world, z up */
  p[0] = p[1] = v[0] = v[1] = 0;
  p[2] = -0.005 * (1 - cos(2 * PI * t));
  v[2] = -0.005 * 2 * PI * sin(2 * PI * t);
}
static void device_write(const double force[3]) {
  (void)force; /* N */
}

static int64_t monotonic_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return INT64_C(1000000000) * t.tv_sec + t.tv_nsec;
}

/* The lock that proves to others that this process lives. */
static int lock_device_byte(int fd) {
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = TEGOTAE_SHM_LOCK_DEVICE, .l_len = 1};
  return fcntl(fd, F_OFD_SETLK, &lock) == 0;
}

/* Creates the segment; takes over the name when the process that had it is dead. The file stays open: it holds the
 * lock. (The library also checks that the name still means the file it has locked, for drivers that start at once.) */
static struct tegotae_shm_segment* create(const char* name) {
  int fd = shm_open(name, O_RDWR, 0);
  if (fd >= 0) {
    uint64_t magic = 0; /* stored last: a creator that died early left zero */
    if (pread(fd, &magic, sizeof magic, 0) < 0 || (magic != 0 && magic != TEGOTAE_SHM_MAGIC)) return NULL; /* foreign */
    if (!lock_device_byte(fd)) return NULL; /* it lives */
    shm_unlink(name);
    close(fd);
  }
  fd = shm_open(name, O_RDWR | O_CREAT | O_EXCL, S_IRUSR | S_IWUSR);
  if (fd < 0 || !lock_device_byte(fd) || posix_fallocate(fd, 0, sizeof(struct tegotae_shm_segment)) != 0) return NULL;
  struct tegotae_shm_segment* s = mmap(NULL, sizeof *s, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (s == MAP_FAILED) return NULL;
  s->version = TEGOTAE_SHM_VERSION;
  s->size = sizeof *s;
  s->owner_pid = (uint64_t)getpid();
  s->created_ns = monotonic_ns();
  __atomic_store_n(&s->magic, TEGOTAE_SHM_MAGIC, __ATOMIC_RELEASE);
  return s;
}

/* Where the pen's zero is in the world: the application may say "this is home". */
static double offset[3];
static int64_t attachment;
static uint32_t home_counter;
static void obey(const struct tegotae_shm_application* a, const double p[3]) {
  if (a->attachment != attachment) home_counter = 0; /* another application counts anew */
  attachment = a->attachment;
  if (a->home_counter == home_counter) return;
  home_counter = a->home_counter;
  for (int i = 0; i < 3; ++i) offset[i] = a->home_position[i] - p[i];
}

/* The spring and damper between the part X and the pen Y, for a part that does not turn. Returns the reason when there
 * is not a force. */
static uint32_t wrench(const struct tegotae_shm_application* a, int64_t now, const struct tegotae_shm_device* d,
                       double force[3]) {
  double square = 0;
  force[0] = force[1] = force[2] = 0;
  if (a->attachment == 0 || !a->enable) return TEGOTAE_SHM_REASON_SOFTWARE;
  if (a->heartbeat_ns > now + TIMEOUT_NS || a->heartbeat_ns < now - TIMEOUT_NS) return TEGOTAE_SHM_REASON_WATCHDOG;
  if (!a->touching) return TEGOTAE_SHM_REASON_NONE;
  double f[3];
  for (int i = 0; i < 3; ++i) {
    f[i] = a->stiffness * (a->position[i] - d->position[i]) + a->damping * (a->velocity[i] - d->velocity[i]);
    square += f[i] * f[i];
  }
  if (!isfinite(square)) return TEGOTAE_SHM_REASON_NOT_FINITE;
  const double scale = square > FORCE_LIMIT * FORCE_LIMIT ? FORCE_LIMIT / sqrt(square) : 1;
  for (int i = 0; i < 3; ++i) force[i] = scale * f[i];
  return TEGOTAE_SHM_REASON_NONE;
}

int main(int argc, char** argv) {
  if (argc != 3) return fprintf(stderr, "usage: driver NAME SECONDS\n"), 2;
  struct tegotae_shm_segment* segment = create(argv[1]);
  if (segment == NULL) return fprintf(stderr, "driver: %s is in use or cannot be created\n", argv[1]), 2;

  struct tegotae_shm_application application = {0};
  struct tegotae_shm_device out = {.orientation = {1}, .raw_orientation = {1}, .scale = 1, .name = "example in C"};
  out.motion_freedom = out.force_freedom = 3;
  out.force_limit = FORCE_LIMIT;
  const int64_t begin = monotonic_ns(), end = begin + (int64_t)(1e9 * atof(argv[2]));
  for (int64_t next = begin; next < end; next += PERIOD_NS, ++out.tick, ++out.sequence) {
    const struct timespec wake = {next / 1000000000, next % 1000000000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, NULL) != 0) {
    }
    const int64_t now = monotonic_ns();
    struct tegotae_shm_application newest;
    if (tegotae_shm_read(&segment->application_counter, segment->application, &newest, sizeof newest))
      application = newest;
    device_read(1e-9 * (double)(now - begin), out.raw_position, out.velocity);
    obey(&application, out.raw_position);
    for (int i = 0; i < 3; ++i) out.position[i] = out.raw_position[i] + offset[i];
    out.reason = wrench(&application, now, &out, out.force);
    device_write(out.force);
    out.status = out.reason == TEGOTAE_SHM_REASON_NONE ? TEGOTAE_SHM_STATUS_ENABLED : TEGOTAE_SHM_STATUS_READY;
    out.heartbeat_ns = out.time_ns = now;
    out.attachment = attachment;
    out.home_counter = home_counter;
    tegotae_shm_write(&segment->device_counter, segment->device, &out, sizeof out);
  }
  const double zero[3] = {0, 0, 0};
  device_write(zero);
  shm_unlink(argv[1]);
  return 0;
}
