#ifndef TEGOTAE_TEGOTAE_H
#define TEGOTAE_TEGOTAE_H

/* The C interface, also for languages that call C: C#, Unity, Rust, Python. A scene has parts, and a rig connects it to
 * a pen. SI units: m, s, N, N·m; quaternions are w, x, y, z. `double pose[7]` is x, y, z, then the quaternion: the
 * part's file frame in the world.
 *
 * Functions that return int return 0, or a negative number when they fail. Functions that return a pointer return NULL
 * when they fail. tegotae_last_error() then says why. A call that fails changes nothing. No exception leaves a call.
 *
 * Threads: use a scene in one thread at a time, and a rig in the thread that steps it. Any thread may call
 * tegotae_rig_part(), tegotae_rig_lead() and tegotae_rig_change(). Destroy a rig when no other call on it runs. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define TEGOTAE_C_EXPORT __attribute__((visibility("default")))
#else
#define TEGOTAE_C_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tegotae_scene tegotae_scene; /**< parts and settings */
typedef struct tegotae_rig tegotae_rig;     /**< a scene connected to a pen */

/** Report of a step. */
struct tegotae_tick {
  double part[7];     /**< X: the held part's pose */
  double pen[7];      /**< Y: where the pen wants it */
  double force[3];    /**< N, on the pen, world: the newest rendered force */
  double torque[3];   /**< N·m, about the held part's center of mass */
  double gap;         /**< m, smallest known gap; infinite when nothing is within reach */
  double lag;         /**< m, how far the part lags the pen */
  int32_t contacts;   /**< number of contacts for tegotae_rig_contacts() */
  int32_t touching;   /**< 1: something holds the part back; 0: it follows freely */
  int32_t connected;  /**< 1: there is a pen */
  int32_t lag_reason; /**< 0 none, 1 contact, 2 time, 3 capacity, 4 suspended: see docs/concepts.md */
};

/** Place where the held part A touches a fixed part B. */
struct tegotae_contact {
  uint32_t part;      /**< B, as tegotae_scene_add() numbered it */
  int32_t began;      /**< 1 in the first step of a contact */
  double point_a[3];  /**< on A, m, world */
  double point_b[3];  /**< on B, m, world */
  double normal[3];   /**< unit, from B to A, world */
  double gap;         /**< m */
  double force;       /**< N, along the normal on A; NaN: not known */
  double friction[3]; /**< N, on A across the normal, world */
  int32_t slides;     /**< nonzero: A's point has slid in the step, where there is friction */
};

/** Source of a rig's time: the machine's clock, or each step advances it by a millisecond, and the run repeats bit for
 * bit. */
enum tegotae_clock { TEGOTAE_CLOCK_REAL = 0, TEGOTAE_CLOCK_SIMULATED = 1 };

/** Returns the version of the library, e.g. "0.1.0". */
TEGOTAE_C_EXPORT const char* tegotae_version(void);
/** Returns why the last call that failed in this thread did; "" when none has. Valid until the next call in this
 * thread. */
TEGOTAE_C_EXPORT const char* tegotae_last_error(void);

/** Makes a scene without parts. Release it with tegotae_scene_destroy(). */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_create(void);
/** Reads the scene of a file (docs/scene-file.md). Fails in a library that was built without file formats. */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_load(const char* path);
/** Writes the deviations of the scene from its mesh files (docs/formats.md) to `text`, each as a line "FILE: what" in
 * UTF-8 that ends with a line feed. Writes at most `capacity` bytes, of which the last is 0. Returns the number of
 * bytes of the whole text without that one; 0 when there are no deviations. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_notes(const tegotae_scene* scene, char* text, size_t capacity);
/** Adds a part: `vertex_count` times x, y, z, and `triangle_count` times three indices, counterclockwise seen from
 * outside. Exactly one part of a scene is `held`. Returns the part's number, from 0 on, or a negative number. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_add(tegotae_scene* scene, const char* name, const double* vertices,
                                           size_t vertex_count, const uint32_t* triangles, size_t triangle_count,
                                           const double pose[7], int held);
/** Moves part `part` to `pose`. */
TEGOTAE_C_EXPORT int tegotae_scene_move(tegotae_scene* scene, uint32_t part, const double pose[7]);
/** Destroys a scene. Rigs that were made of it continue. NULL has no effect. */
TEGOTAE_C_EXPORT void tegotae_scene_destroy(tegotae_scene* scene);

/** Makes a rig of the scene in its present state; `clock` is an enum tegotae_clock. `device` is "shm:NAME", a device in
 * another process, with TEGOTAE_CLOCK_REAL; or NULL: a simulated pen, whose hand starts at the held part and follows
 * tegotae_rig_lead(). */
TEGOTAE_C_EXPORT tegotae_rig* tegotae_rig_create(const tegotae_scene* scene, const char* device, int clock);
/** Stops and destroys a rig. NULL has no effect. */
TEGOTAE_C_EXPORT void tegotae_rig_destroy(tegotae_rig* rig);
/** Starts pen and servo. */
TEGOTAE_C_EXPORT int tegotae_rig_start(tegotae_rig* rig);
/** Runs one step of the contact loop, and writes its report unless `tick` is NULL. */
TEGOTAE_C_EXPORT int tegotae_rig_step(tegotae_rig* rig, struct tegotae_tick* tick);
/** Stops pen and servo. */
TEGOTAE_C_EXPORT int tegotae_rig_stop(tegotae_rig* rig);
/** Writes the contacts of the last step, at most `capacity` of them. Returns how many there are. */
TEGOTAE_C_EXPORT int64_t tegotae_rig_contacts(const tegotae_rig* rig, struct tegotae_contact* contacts,
                                              size_t capacity);
/** Writes the pose of the held part. Any thread may call it. */
TEGOTAE_C_EXPORT int tegotae_rig_part(const tegotae_rig* rig, double pose[7]);
/** Makes the simulated hand carry the held part to `pose`, as fast as a hand can. Any thread may call it. */
TEGOTAE_C_EXPORT int tegotae_rig_lead(tegotae_rig* rig, const double pose[7]);
/** Continues in the present state of the scene; the held part continues from where it is. Any thread may call it. Waits
 * at most `seconds` until the change is in force, for which another thread must step the rig. After that time it
 * cancels the change and fails; it also fails when a later change has replaced this one. With 0 seconds it does not
 * wait, and the change comes into force when it can. */
TEGOTAE_C_EXPORT int tegotae_rig_change(tegotae_rig* rig, const tegotae_scene* scene, double seconds);

#ifdef __cplusplus
}
#endif

#endif
