/** @file
 * Shared-memory protocol between a haptic device (with its servo loop) and an application (with its contact loop).
 * Plain C11, also valid C++17; it depends only on the C library and the __atomic builtins of GCC and Clang.
 *
 * There is one segment for each device: a POSIX shared-memory object of exactly sizeof(struct tegotae_shm_segment)
 * bytes, owned by the user and with permission 0600, in the machine's byte order. A process that attaches checks owner,
 * permission, size, magic and version before use. While they live, the device's process and the application each hold a
 * write lock (F_OFD_SETLK) on a byte of the object. A device that cannot lock its byte reports that the name is in use.
 * A device that can lock it replaces the object of a dead process: it unlinks the object and creates it anew.
 *
 * Units: m, rad, s, N, N*m; times are CLOCK_MONOTONIC in ns; quaternions are w, x, y, z and of unit length; all vectors
 * are expressed in the world.
 *
 * Every slot has one writer and any number of readers. A sequence counter guards it (a seqlock): 0 = never written, odd
 * = being written, even = complete. Neither side ever waits for the other.
 *
 * Memory order. The writer makes the counter odd, stores the payload word by word with release, and stores the even
 * counter with release. The reader loads the counter with acquire, the words with acquire, and the counter again.
 *  - Not older than announced: an even value read first synchronizes with its store, so every word is at least as new.
 *  - Not newer: if any word comes from a later write, its acquire load synchronizes with that word's release store,
 *    before which the counter had been made odd. The second load of the counter must then see that or a later value,
 *    which differs from the first, and the reader rejects the read.
 *
 * All shared accesses are atomic, so there is no data race in the sense of the language, and no fence is needed. */
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/** @def TEGOTAE_SHM_ALIGN
 * Gives a member a cache line of its own, so that one slot's writer does not slow down another's readers. */
/** @def TEGOTAE_SHM_ASSERT
 * Fails to compile, with `text`, unless `condition` holds. */
#ifdef __cplusplus
#define TEGOTAE_SHM_ALIGN alignas(64)
#define TEGOTAE_SHM_ASSERT(condition, text) static_assert(condition, text)
#else
#define TEGOTAE_SHM_ALIGN _Alignas(64)
#define TEGOTAE_SHM_ASSERT(condition, text) _Static_assert(condition, text)
#endif

/** The bytes "TEGOTAE1" in little-endian order. */
#define TEGOTAE_SHM_MAGIC UINT64_C(0x314541544F474554)
/** Changes with every change of the layout or of a field's meaning. */
#define TEGOTAE_SHM_VERSION UINT32_C(6)

/** Offsets of the bytes that the device's process and the application lock. The kernel ends a lock of an open file
 * description with the process that holds it, so the lock proves that the process lives. */
enum { TEGOTAE_SHM_LOCK_DEVICE = 0, TEGOTAE_SHM_LOCK_APPLICATION = 1 };

/** tegotae_shm_device.status */
enum {
  TEGOTAE_SHM_STATUS_UNINITIALIZED = 0, /**< not started: no pose, no force */
  TEGOTAE_SHM_STATUS_READY = 1,         /**< the pose is good, the force is off (see reason) */
  TEGOTAE_SHM_STATUS_ENABLED = 2        /**< the pose is good and the wrench is rendered */
};

/** tegotae_shm_device.reason: why the force is off, or on its way to zero */
enum {
  TEGOTAE_SHM_REASON_NONE = 0,            /**< it is on */
  TEGOTAE_SHM_REASON_BUTTON = 1,          /**< the device's force button is off */
  TEGOTAE_SHM_REASON_VELOCITY = 2,        /**< the pen moved too fast */
  TEGOTAE_SHM_REASON_WATCHDOG = 3,        /**< the application's heartbeat is too old */
  TEGOTAE_SHM_REASON_SOFTWARE = 4,        /**< no application asks for force */
  TEGOTAE_SHM_REASON_DISCONNECTED = 5,    /**< the device does not answer */
  TEGOTAE_SHM_REASON_DEAD_MAN = 6,        /**< the dead-man switch is released */
  TEGOTAE_SHM_REASON_NOT_FINITE = 7,      /**< a pose, velocity or setting is not finite, or impossible */
  TEGOTAE_SHM_REASON_WORKSPACE = 8,       /**< the pen left its workspace */
  TEGOTAE_SHM_REASON_ENERGY = 9,          /**< the coupling gave the hand more energy than allowed: unstable */
  TEGOTAE_SHM_REASON_THERMAL = 10,        /**< the device's motors are too warm */
  TEGOTAE_SHM_REASON_ENGAGE = 11,         /**< waits until the wanted force is small, then ramps in */
  TEGOTAE_SHM_REASON_CLUTCHED = 12,       /**< the pen is clutched and moves without the part */
  TEGOTAE_SHM_REASON_SILENT = 13,         /**< the pen has sent no new sample for too long */
  TEGOTAE_SHM_REASON_DEVICE_FAULT = 14,   /**< the device reports a fault */
  TEGOTAE_SHM_REASON_FORCE_EXCEEDED = 15, /**< the device reports a request above what it may render */
  TEGOTAE_SHM_REASON_NO_FORCE = 16        /**< the device is an input only and renders no force */
};
/** Capacity for reasons in tegotae_shm_statistics.force_off: the reasons above, and later ones. */
#define TEGOTAE_SHM_REASONS 24

/** tegotae_shm_device.flags: what the safety chain does to a force that is on */
enum {
  TEGOTAE_SHM_FLAG_SATURATED = 1,  /**< scaled down to the limits */
  TEGOTAE_SHM_FLAG_SLEW = 2,       /**< changes as fast as allowed, and lags the wanted force */
  TEGOTAE_SHM_FLAG_RAMP = 4,       /**< ramps in after it was enabled */
  TEGOTAE_SHM_FLAG_THERMAL = 8,    /**< scaled down to what the motors can sustain */
  TEGOTAE_SHM_FLAG_WORKSPACE = 16, /**< fades at the border of the workspace */
  TEGOTAE_SHM_FLAG_DAMPED = 32,    /**< the passivity controller takes energy out */
  TEGOTAE_SHM_FLAG_LOCAL = 64      /**< the servo updated the part's pose on the contact planes */
};

/** tegotae_shm_application.clutch and tegotae_shm_device.clutch: which part of the pen's motion the held part does not
 * follow */
enum {
  TEGOTAE_SHM_CLUTCH_NONE = 0,        /**< it follows all of it */
  TEGOTAE_SHM_CLUTCH_TRANSLATION = 1, /**< the part turns with the pen but stays in its place */
  TEGOTAE_SHM_CLUTCH_ALL = 2          /**< the part does not move */
};

/** tegotae_shm_statistics.realtime: what the system granted to the servo's thread */
enum {
  TEGOTAE_SHM_REALTIME_FIFO = 1,        /**< SCHED_FIFO */
  TEGOTAE_SHM_REALTIME_MEMORY = 2,      /**< its memory is locked */
  TEGOTAE_SHM_REALTIME_TIMER_SLACK = 4, /**< its wake-ups are not batched */
  TEGOTAE_SHM_REALTIME_AFFINITY = 8     /**< it runs on one CPU */
};

/** Bytes of tegotae_shm_device.name. */
#define TEGOTAE_SHM_NAME 32
/** Largest number of contact planes in tegotae_shm_application.planes: a free body has six degrees of freedom. */
#define TEGOTAE_SHM_PLANES 6

/** The device's side writes this once a servo tick. The pen moves in the device's own space, in meters; the axes of
 * that space are those of the world. The mapping (scale, clutch, home) turns the pen's pose into Y, where the pen wants
 * the held part. */
struct tegotae_shm_device {
  int64_t heartbeat_ns;             /**< time of the servo tick */
  uint64_t tick;                    /**< number of the servo tick, from 0 */
  int64_t time_ns;                  /**< time of the pen's sample (in virtual time, of the device's own clock) */
  uint64_t sequence;                /**< number of the pen's sample */
  uint32_t status;                  /**< TEGOTAE_SHM_STATUS_... */
  uint32_t reason;                  /**< TEGOTAE_SHM_REASON_... */
  uint32_t buttons;                 /**< bit i: button i is pressed */
  uint32_t flags;                   /**< TEGOTAE_SHM_FLAG_..., added */
  uint32_t motion_freedom;          /**< degrees of freedom that the device senses: 3 or 6 */
  uint32_t force_freedom;           /**< degrees of freedom that it renders: 0 (input only), 3 or 6 */
  char name[TEGOTAE_SHM_NAME];      /**< of the device, UTF-8, ends with a zero byte */
  double position[3];               /**< Y: where the pen wants the held part's file frame */
  double orientation[4];            /**< of the same */
  double velocity[3];               /**< of the held part's center of mass, as carried by the pen */
  double angular_velocity[3];       /**< of the same */
  double force[3];                  /**< on the pen, after the safety chain, at the center of mass */
  double torque[3];                 /**< about the center of mass */
  double raw_position[3];           /**< of the pen in the device's space, before the mapping */
  double raw_orientation[4];        /**< of the same */
  double scale;                     /**< meters of the world for a meter of the pen */
  uint32_t clutch;                  /**< TEGOTAE_SHM_CLUTCH_...: by the application or by a button */
  uint32_t home_counter;            /**< the application's last home command that the servo executed */
  double force_limit;               /**< N, upper bound of the rendered force */
  double torque_limit;              /**< N*m, upper bound of the rendered torque */
  double continuous_force;          /**< N, force that the motors can sustain; 0: unbounded */
  double stiffness_limit;           /**< N/m, the stiffest passive coupling of this device and rate; 0: not known */
  double torsional_stiffness_limit; /**< N*m/rad, the same for rotations */
  double thermal_load; /**< running RMS of the force divided by continuous_force: up to 1; 0 if unbounded */
  double energy;       /**< J that the hand has put into the coupling, less what it got back */
  int64_t attachment;  /**< the one of the application that the servo serves; 0: none yet */
};

/** A constraint that holds the part back: its point `point` may move against `normal` by at most `clearance`. */
struct tegotae_shm_plane {
  double normal[3]; /**< unit, out of the obstacle, world */
  double point[3];  /**< of the held part when it is at tegotae_shm_application.position, world, m */
  double clearance; /**< m; negative: the point should move out by this much */
  double mu;        /**< coefficient of friction while the plane holds the point, 0 to 10 */
};

/** The application writes this once a tick of its contact loop. */
struct tegotae_shm_application {
  int64_t heartbeat_ns;     /**< time of writing */
  uint64_t tick;            /**< number of the contact loop's tick */
  uint64_t device_sequence; /**< the pen's sample that this tick answered */
  int64_t attachment;       /**< time when this application attached, ns: another value is another application */
  uint32_t touching;        /**< nonzero: at least one contact; otherwise the wrench is the load */
  uint32_t enable;          /**< nonzero: the application asks for force */
  uint32_t clutch;          /**< TEGOTAE_SHM_CLUTCH_...: motion of the pen that the part does not follow now */
  uint32_t home_counter; /**< a new value other than 0 makes Y jump to the home pose; begins at 0 in each attachment */
  double position[3];    /**< of the held part's file frame (the proxy X) */
  double orientation[4]; /**< of the same */
  double velocity[3];    /**< of the held part's center of mass */
  double angular_velocity[3]; /**< of the same */
  double center[3];           /**< center of mass of the held part, in its file frame */
  double stiffness;           /**< N/m, as the hand feels it at any scale */
  double damping;             /**< N*s/m */
  double torsional_stiffness; /**< N*m/rad */
  double torsional_damping;   /**< N*m*s/rad */
  double scale;               /**< meters of the world for a meter of the pen, from 0.01 to 100 */
  double home_position[3];    /**< of the held part's file frame */
  double home_orientation[4]; /**< of the same */
  double load_force[3];       /**< N, of weight and guide, on the pen at the held part's center of mass; 0: none */
  double load_torque[3];      /**< N*m, of the same about that center */
  double pen_position[3];     /**< Y that this tick answered */
  double pen_orientation[4];  /**< of the same */
  uint32_t plane_count;       /**< number of valid planes, up to TEGOTAE_SHM_PLANES; 0: X stays until the next tick */
  uint32_t reserved;          /**< 0 */
  struct tegotae_shm_plane planes[TEGOTAE_SHM_PLANES]; /**< the first plane_count of them */
};

/** The servo writes this a few times a second. Times are in microseconds; lateness is wake-up minus schedule. */
struct tegotae_shm_statistics {
  uint64_t ticks;                          /**< ticks since the servo was made */
  uint64_t missed;                         /**< periods of the schedule that had no tick */
  double set_rate_hz;                      /**< of the schedule */
  double rate_hz;                          /**< achieved, mean */
  double late_us[4];                       /**< p50, p99, p99.9, maximum */
  double compute_us[4];                    /**< the servo's own work in a tick: p50, p99, p99.9, maximum */
  uint32_t realtime;                       /**< TEGOTAE_SHM_REALTIME_..., added */
  int32_t cpu;                             /**< CPU to which the thread is bound; -1: none */
  uint64_t force_off[TEGOTAE_SHM_REASONS]; /**< by reason: how often the force went off, or stayed off, for it */
  double recent_late_us;                   /**< the largest lateness since the statistics before these */
};

/** Words (8 bytes) of the payload struct `type`. */
#define TEGOTAE_SHM_WORDS(type) (sizeof(struct type) / sizeof(uint64_t))

/** The whole object. Each slot is an array of words, guarded by the counter before it. */
struct tegotae_shm_segment {
  uint64_t magic;       /**< stored last by the creator, with release */
  uint32_t version;     /**< TEGOTAE_SHM_VERSION */
  uint32_t size;        /**< bytes of the whole segment */
  uint64_t owner_pid;   /**< the process that created it */
  int64_t created_ns;   /**< time of its creation */
  uint64_t owner_start; /**< start of that process, which distinguishes a reused process id: clock ticks since
                           boot (field 22 of /proc/PID/stat); 0: not known */

  TEGOTAE_SHM_ALIGN uint64_t device_counter;              /**< sequence counter of the slot that follows */
  uint64_t device[TEGOTAE_SHM_WORDS(tegotae_shm_device)]; /**< struct tegotae_shm_device */

  TEGOTAE_SHM_ALIGN uint64_t application_counter;                   /**< sequence counter of the slot that follows */
  uint64_t application[TEGOTAE_SHM_WORDS(tegotae_shm_application)]; /**< struct tegotae_shm_application */

  TEGOTAE_SHM_ALIGN uint64_t statistics_counter;                  /**< sequence counter of the slot that follows */
  uint64_t statistics[TEGOTAE_SHM_WORDS(tegotae_shm_statistics)]; /**< struct tegotae_shm_statistics */
};

/* Offsets are part of the protocol: readers in other languages use these numbers. */
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_device) == 376, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, status) == 32, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, name) == 56, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, position) == 88, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, force) == 192, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, raw_position) == 240, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, scale) == 296, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_device, attachment) == 368, "layout of tegotae_shm_device");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_plane) == 64, "layout of tegotae_shm_plane");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_application) == 768, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_application, touching) == 32, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_application, position) == 48, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_application, scale) == 208, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_application, plane_count) == 376, "layout of tegotae_shm_application");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_statistics) == 304, "layout of tegotae_shm_statistics");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_statistics, force_off) == 104, "layout of tegotae_shm_statistics");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, device_counter) == 64, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, application_counter) == 448, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(offsetof(struct tegotae_shm_segment, statistics_counter) == 1280, "layout of tegotae_shm_segment");
TEGOTAE_SHM_ASSERT(sizeof(struct tegotae_shm_segment) == 1600, "layout of tegotae_shm_segment");

/** Attempts of a read before it gives up. A write takes well under a microsecond. When all attempts fail, the writer
 * was preempted or killed during a write, and the reader continues with what it read last. */
#define TEGOTAE_SHM_READ_ATTEMPTS 64

/** Writes `bytes` (a multiple of 8) of `payload` into a slot. Only the slot's one writer may call it. */
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

/** Reads a slot into `payload`. Returns 1 when `payload` holds one complete write. Returns 0 when the slot was never
 * written or its writer is stuck in a write; `payload` is then undefined. */
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
