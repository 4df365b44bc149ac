#ifndef TEGOTAE_TEGOTAE_H
#define TEGOTAE_TEGOTAE_H

/* The C interface, also for languages that call C: C#, Unity, Rust, Python. A scene has parts. A rig connects a scene
 * to a pen. SI units: m, s, N, N·m. `double pose[7]` is x, y, z, then the quaternion w, x, y, z (of any length above
 * 0): the pose of the part's file frame in the world.
 *
 * Errors: functions that return int return 0, and functions that return int64_t return a number; all return a negative
 * number when they fail. Functions that return a pointer return NULL when they fail. tegotae_last_error() then says
 * why. A call that fails changes nothing. No C++ exception leaves a call.
 *
 * Threads: use a scene in one thread at a time, and a rig in the thread that steps it. Other threads may call
 * tegotae_rig_part(), tegotae_rig_lead() and tegotae_rig_change() meanwhile. Destroy a rig when no other call on it
 * runs. */

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

/** Report of a step. Vectors are in the axes of the world. */
struct tegotae_tick {
  double part[7];     /**< X: pose of the held part */
  double pen[7];      /**< Y: pose where the pen wants the held part */
  double force[3];    /**< N, on the pen: the newest rendered force */
  double torque[3];   /**< N·m, on the pen, about the held part's center of mass */
  double gap;         /**< m, smallest known gap; infinite: nothing is within reach */
  double lag;         /**< m, how far the part lags the pen */
  int32_t contacts;   /**< number of contacts for tegotae_rig_contacts() */
  int32_t touching;   /**< 1: something holds the part back; 0: it follows freely */
  int32_t connected;  /**< 1: there was a pen in this step; 0: there was none */
  int32_t lag_reason; /**< 0 none, 1 contact, 2 time, 3 capacity, 4 suspended: see docs/concepts.md */
};

/** Place where the held part A touches a fixed part B. */
struct tegotae_contact {
  uint32_t part;      /**< B: number of the fixed part */
  int32_t began;      /**< 1: the contact began in this step */
  double point_a[3];  /**< on A, m, world */
  double point_b[3];  /**< on B, m, world */
  double normal[3];   /**< unit, from B to A, world */
  double gap;         /**< m */
  double force;       /**< N, on A along the normal; NaN: not known */
  double friction[3]; /**< N, on A across the normal, world */
  int32_t slides;     /**< 1: there is friction, and A's point slid in this step */
};

/** Source of a rig's time. TEGOTAE_CLOCK_REAL: the machine's clock. TEGOTAE_CLOCK_SIMULATED: each step advances the
 * time by a millisecond, and the same run repeats bit for bit. */
enum tegotae_clock { TEGOTAE_CLOCK_REAL = 0, TEGOTAE_CLOCK_SIMULATED = 1 };

/** Returns the version of the library, e.g. "0.1.0". */
TEGOTAE_C_EXPORT const char* tegotae_version(void);
/** Returns why the most recent failed call in this thread failed, in one line; "" when none has failed. The text is
 * valid until the next call in this thread. */
TEGOTAE_C_EXPORT const char* tegotae_last_error(void);

/** Makes a scene without parts. Release it with tegotae_scene_destroy(). */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_create(void);
/** Reads the scene of a scene file (docs/scene-file.md). Release it with tegotae_scene_destroy(). Fails when the file
 * cannot be used, and in a library that was built without file formats. */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_load(const char* path);
/** Writes the deviations of the scene from its mesh files (docs/formats.md) to `text`: one line "FILE: what" for each,
 * in UTF-8, each with a line feed at its end. Writes at most `capacity` bytes; the last one is 0. With a `capacity` of
 * 0, `text` may be NULL. Returns the number of bytes of the whole text, without the final 0; it is 0 when there are no
 * deviations. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_notes(const tegotae_scene* scene, char* text, size_t capacity);
/** Adds a part with a surface in its file frame: `vertices` has `vertex_count` times x, y, z in m, and `triangles` has
 * `triangle_count` times three indices into them, counterclockwise seen from outside. A nonzero `held` makes it the
 * part that the pen holds; a scene has exactly one. Returns the part's number, from 0 on. Fails when a vertex is not
 * finite or beyond 1000 km, an index is out of range, or the pose is not finite or beyond 10 km. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_add(tegotae_scene* scene, const char* name, const double* vertices,
                                           size_t vertex_count, const uint32_t* triangles, size_t triangle_count,
                                           const double pose[7], int held);
/** Moves part number `part` to `pose`. Fails when there is no such part, or the pose is not finite or beyond 10 km. */
TEGOTAE_C_EXPORT int tegotae_scene_move(tegotae_scene* scene, uint32_t part, const double pose[7]);
/** Destroys a scene. Rigs that were made of it continue. NULL has no effect. */
TEGOTAE_C_EXPORT void tegotae_scene_destroy(tegotae_scene* scene);

/** Makes a rig of the scene in its present state; release it with tegotae_rig_destroy(). `clock` is an enum
 * tegotae_clock. `device` is "shm:NAME", a device in another process, which needs TEGOTAE_CLOCK_REAL. Or it is NULL: a
 * simulated pen, whose hand starts at the held part and follows tegotae_rig_lead(). Fails when parts overlap at the
 * start, the scene does not have exactly one held part, or there is no such device. */
TEGOTAE_C_EXPORT tegotae_rig* tegotae_rig_create(const tegotae_scene* scene, const char* device, int clock);
/** Stops and destroys a rig. NULL has no effect. */
TEGOTAE_C_EXPORT void tegotae_rig_destroy(tegotae_rig* rig);
/** Starts the pen and its servo. Has no effect on a rig that runs. */
TEGOTAE_C_EXPORT int tegotae_rig_start(tegotae_rig* rig);
/** Runs one step of the contact loop, and writes its report to `tick` unless that is NULL. On a rig that does not run
 * it only writes the last report. */
TEGOTAE_C_EXPORT int tegotae_rig_step(tegotae_rig* rig, struct tegotae_tick* tick);
/** Switches the force off, and stops the pen and its servo. Has no effect on a rig that does not run. */
TEGOTAE_C_EXPORT int tegotae_rig_stop(tegotae_rig* rig);
/** Writes the contacts of the last step to `contacts`, at most `capacity` of them. Returns how many contacts there are.
 * With a `capacity` of 0, `contacts` may be NULL. */
TEGOTAE_C_EXPORT int64_t tegotae_rig_contacts(const tegotae_rig* rig, struct tegotae_contact* contacts,
                                              size_t capacity);
/** Writes the pose of the held part after the last step to `pose`. Any thread may call it. */
TEGOTAE_C_EXPORT int tegotae_rig_part(const tegotae_rig* rig, double pose[7]);
/** Makes the simulated hand carry the held part to `pose`, as fast as a hand can. Any thread may call it, but only one
 * at a time. Fails when the pen belongs to another process. */
TEGOTAE_C_EXPORT int tegotae_rig_lead(tegotae_rig* rig, const double pose[7]);
/** Continues in the present state of `scene`. The held part continues from where it is; another held part starts at its
 * pose in `scene`. Any thread may call it. The
 * call waits at most `seconds` until the change is in force; another thread must step the rig meanwhile. After that
 * time it cancels the change and fails. It also fails when a later change has replaced this one. With 0 seconds it does
 * not wait, and the change comes into force when it can. */
TEGOTAE_C_EXPORT int tegotae_rig_change(tegotae_rig* rig, const tegotae_scene* scene, double seconds);

#ifdef __cplusplus
}
#endif

#endif
