/* Shared-memory protocol between a haptic device (with its servo loop) and an application (with its contact loop).
 * Plain C11, also valid C++17; no dependency but the C library and the __atomic builtins of GCC and Clang.
 *
 * One segment a device: a POSIX shared-memory object of exactly sizeof(struct tegotae_shm_segment) bytes, owned by the
 * user and with permission 0600, in the machine's byte order. Whoever attaches checks owner, permission, size, magic
 * and version before use. Units: m, rad, s, N, N*m; times are CLOCK_MONOTONIC in ns; quaternions are w, x, y, z and of
 * unit length; all vectors are expressed in the world.
 *
 * Every slot has one writer and any number of readers, and is guarded by a sequence counter (a seqlock):
 *   0 = never written, odd = a write is going on, even = whole. Neither side ever waits for the other.
 *
 * Memory order. The writer makes the counter odd, stores the payload word by word with release, and stores the even
 * counter with release. The reader loads the counter with acquire, the words with acquire, and the counter again.
 *  - Not older than announced: an even value read first synchronizes with its store, so every word is at least as new.
 *  - Not newer: if any word comes from a later write, its acquire load synchronizes with that word's release store,
 *    before which the counter had been made odd; the second load of the counter must then see that or a later value,
 *    which differs from the first, and the read is rejected.
 * All shared accesses are atomic, so there is no data race in the sense of the language, and no fence is needed. */
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
#define TEGOTAE_SHM_ALIGN alignas(64)
#define TEGOTAE_SHM_ASSERT(condition, text) static_assert(condition, text)
#else
#define TEGOTAE_SHM_ALIGN _Alignas(64)
#define TEGOTAE_SHM_ASSERT(condition, text) _Static_assert(condition, text)
#endif

/* The bytes "TEGOTAE1" in little-endian order. */
#define TEGOTAE_SHM_MAGIC UINT64_C(0x314541544F474554)
/* Changes with every change of the layout or of a field's meaning. */
#define TEGOTAE_SHM_VERSION UINT32_C(1)

/* tegotae_shm_device.status */
enum {
  TEGOTAE_SHM_STATUS_UNINITIALIZED = 0, /* not started: no pose, no force */
  TEGOTAE_SHM_STATUS_READY = 1,         /* the pose is good, the force is off (see reason) */
  TEGOTAE_SHM_STATUS_ENABLED = 2        /* the pose is good and the wrench is rendered */
};

/* tegotae_shm_device.reason: why the force is off */
enum {
  TEGOTAE_SHM_REASON_NONE = 0,         /* it is on */
  TEGOTAE_SHM_REASON_BUTTON = 1,       /* the device's force button is off */
  TEGOTAE_SHM_REASON_VELOCITY = 2,     /* the pen moved too fast */
  TEGOTAE_SHM_REASON_WATCHDOG = 3,     /* the application's heartbeat is too old */
  TEGOTAE_SHM_REASON_SOFTWARE = 4,     /* no application asks for force */
  TEGOTAE_SHM_REASON_DISCONNECTED = 5, /* the device does not answer */
  TEGOTAE_SHM_REASON_DEAD_MAN = 6,     /* the dead-man switch is released */
  TEGOTAE_SHM_REASON_NOT_FINITE = 7    /* a pose, velocity or setting is not finite */
};

/* Written by the device's side, once a servo tick. */
struct tegotae_shm_device {
  int64_t heartbeat_ns;  /* time of the servo tick */
  uint64_t tick;         /* number of the servo tick, from 0 */
  int64_t time_ns;       /* when the pen was sampled (a simulated device in virtual time: its own clock) */
  uint64_t sequence;     /* number of the pen's sample */
  uint32_t status;       /* TEGOTAE_SHM_STATUS_... */
  uint32_t reason;       /* TEGOTAE_SHM_REASON_... */
  uint32_t buttons;      /* bit i: button i is pressed */
  uint32_t reserved;     /* 0 */
  double position[3];    /* where the pen wants the held part's file frame */
  double orientation[4]; /* the same */
  double velocity[3];    /* of the held part's center of mass, as carried by the pen */
  double angular_velocity[3];
  double force[3];  /* on the pen, after the safety chain, at the center of mass */
  double torque[3]; /* about the center of mass */
};

/* Written by the application, once a tick of its contact loop. */
struct tegotae_shm_application {
  int64_t heartbeat_ns;     /* time of writing */
  uint64_t tick;            /* number of the contact loop's tick */
  uint64_t device_sequence; /* the pen's sample that this tick answered */
  uint32_t touching;        /* nonzero: at least one contact; otherwise the wrench is zero */
  uint32_t reserved;        /* 0 */
  double position[3];       /* of the held part's file frame (the proxy X) */
  double orientation[4];
  double velocity[3]; /* of the held part's center of mass */
  double angular_velocity[3];
  double center[3];           /* center of mass of the held part, in its file frame */
  double stiffness;           /* N/m */
  double damping;             /* N*s/m */
  double torsional_stiffness; /* N*m/rad */
  double torsional_damping;   /* N*m*s/rad */
};

/* Written by the servo a few times a second. Times in microseconds; lateness is wake-up minus schedule. */
struct tegotae_shm_statistics {
  uint64_t ticks;
  uint64_t missed;      /* periods of the schedule that had no tick */
  double rate_hz;       /* achieved, mean */
  double late_us[4];    /* p50, p99, p99.9, maximum */
  double compute_us[4]; /* the servo's own work in a tick: p50, p99, p99.9, maximum */
};

#define TEGOTAE_SHM_WORDS(type) (sizeof(struct type) / sizeof(uint64_t))

struct tegotae_shm_segment {
  uint64_t magic; /* stored last by the creator, with release */
  uint32_t version;
  uint32_t size;      /* bytes of the whole segment */
  uint64_t owner_pid; /* the process that created it */
  int64_t created_ns;

  TEGOTAE_SHM_ALIGN uint64_t device_counter;
  uint64_t device[TEGOTAE_SHM_WORDS(tegotae_shm_device)]; /* struct tegotae_shm_device */

  TEGOTAE_SHM_ALIGN uint64_t application_counter;
  uint64_t application[TEGOTAE_SHM_WORDS(tegotae_shm_application)]; /* struct tegotae_shm_application */

  TEGOTAE_SHM_ALIGN uint64_t statistics_counter;
  uint64_t statistics[TEGOTAE_SHM_WORDS(tegotae_shm_statistics)]; /* struct tegotae_shm_statistics */
};

/* Offsets are part of the protocol: readers in other languages use these numbers. */
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_device) == 200, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_application) == 192, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_statistics) == 88, "layout of tegotae_shm_statistics");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, device_counter) == 64, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, application_counter) == 320, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, statistics_counter) == 576, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_segment) == 704, "layout of tegotae_shm_segment");

/* Attempts of a read before it gives up. A write takes well under a microsecond; a reader that still fails has met a
 * writer that was preempted or killed in the middle, and goes on with what it read last. */
#define TEGOTAE_SHM_READ_ATTEMPTS 64

/* Writes `bytes` (a multiple of 8) of `payload` into a slot. Only the slot's one writer may call it. */
static inline void tegotae_shm_write(uint64_t* counter, uint64_t* slot, const void* payload, size_t bytes) {
  const uint64_t before = __atomic_load_n(counter, __ATOMIC_RELAXED);
  /* An odd value was left by a writer that died while writing; the next odd value still announces a new write. */
  const uint64_t busy = (before | 1u) == before ? before + 2 : before + 1;
  __atomic_store_n(counter, busy, __ATOMIC_RELAXED);
  for (size_t i = 0; i < bytes / sizeof(uint64_t); ++i) {
    uint64_t word;
    memcpy(&word, (const unsigned char*)payload + i * sizeof word, sizeof word);
    __atomic_store_n(slot + i, word, __ATOMIC_RELEASE);
  }
  __atomic_store_n(counter, busy + 1, __ATOMIC_RELEASE);
}

/* Reads a slot into `payload`. Returns 1 when `payload` holds one whole write, 0 when nothing was ever written or the
 * writer is stuck in a write; `payload` is then undefined. */
static inline int tegotae_shm_read(const uint64_t* counter, const uint64_t* slot, void* payload, size_t bytes) {
  for (int attempt = 0; attempt < TEGOTAE_SHM_READ_ATTEMPTS; ++attempt) {
    const uint64_t before = __atomic_load_n(counter, __ATOMIC_ACQUIRE);
    if (before == 0) return 0;
    if (before & 1u) continue;
    for (size_t i = 0; i < bytes / sizeof(uint64_t); ++i) {
      const uint64_t word = __atomic_load_n(slot + i, __ATOMIC_ACQUIRE);
      memcpy((unsigned char*)payload + i * sizeof word, &word, sizeof word);
    }
    if (__atomic_load_n(counter, __ATOMIC_RELAXED) == before) return 1;
  }
  return 0;
}
