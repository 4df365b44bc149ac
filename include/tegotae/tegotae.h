#ifndef TEGOTAE_TEGOTAE_H
#define TEGOTAE_TEGOTAE_H

/* The library for C, and for what calls C: C#, Unity, Rust, Python. A scene of parts, and a rig that brings it together
 * with a pen. SI units: m, s, N, N·m; quaternions are w, x, y, z. `double pose[7]` is x, y, z, then the quaternion: the
 * part's file frame in the world.
 *
 * Functions that return int return 0, or a negative number when they failed; functions that return a pointer return
 * NULL then. tegotae_last_error() says why. A call that fails changes nothing. No exception leaves a call.
 *
 * Threads: a scene belongs to one thread at a time. A rig belongs to the thread that steps it, but for
 * tegotae_rig_part(), tegotae_rig_lead() and tegotae_rig_change(), which any thread may call. Destroy a rig when no
 * other call on it is at work. */

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
typedef struct tegotae_rig tegotae_rig;     /**< a scene that is felt */

/** What a step did. */
struct tegotae_tick {
  double part[7];     /**< X: the held part's pose */
  double pen[7];      /**< Y: where the pen wants it */
  double force[3];    /**< N, on the pen, world, as it was rendered lately */
  double torque[3];   /**< N·m, about the held part's center of mass */
  double gap;         /**< m, smallest known one; infinite when nothing is within reach */
  double lag;         /**< m, how far the part is behind the pen */
  int32_t contacts;   /**< for tegotae_rig_contacts() */
  int32_t touching;   /**< 1: the part is held back; 0: it follows freely */
  int32_t connected;  /**< 1: there is a pen */
  int32_t lag_reason; /**< 0 none, 1 contact, 2 time, 3 capacity, 4 suspended: see docs/concepts.md */
};

/** A place where the held part A touches a fixed part B. */
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

/** What a rig's time is: of the machine's clock, or moved on by each step by a millisecond, which repeats bit for bit.
 */
enum tegotae_clock { TEGOTAE_CLOCK_REAL = 0, TEGOTAE_CLOCK_SIMULATED = 1 };

/** Of the library, e.g. "0.1.0". */
TEGOTAE_C_EXPORT const char* tegotae_version(void);
/** Why the last call in this thread that failed did; "" when none has. Valid until the next call in this thread. */
TEGOTAE_C_EXPORT const char* tegotae_last_error(void);

/** A scene without parts. To be given to tegotae_scene_destroy(). */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_create(void);
/** The scene of a file (docs/scene-file.md). Fails in a library that was built without file formats. */
TEGOTAE_C_EXPORT tegotae_scene* tegotae_scene_load(const char* path);
/** What is not as the mesh files of the scene say (docs/formats.md), "FILE: what" in UTF-8, a line each that ends with
 * a line feed. Writes at most `capacity` bytes to `text`, of which the last is 0, and returns how many bytes the whole
 * has without that one: 0 when there is nothing to tell. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_notes(const tegotae_scene* scene, char* text, size_t capacity);
/** Adds a part: `vertex_count` times x, y, z, and `triangle_count` times three indices, counterclockwise seen from
 * outside. Exactly one part of a scene is `held`. Returns the part's number, from 0 on, or a negative number. */
TEGOTAE_C_EXPORT int64_t tegotae_scene_add(tegotae_scene* scene, const char* name, const double* vertices,
                                           size_t vertex_count, const uint32_t* triangles, size_t triangle_count,
                                           const double pose[7], int held);
/** Places part `part` elsewhere. */
TEGOTAE_C_EXPORT int tegotae_scene_move(tegotae_scene* scene, uint32_t part, const double pose[7]);
/** Rigs that were made of it go on. NULL is let be. */
TEGOTAE_C_EXPORT void tegotae_scene_destroy(tegotae_scene* scene);

/** A rig of the scene as it is now; `clock` is an enum tegotae_clock. `device`: "shm:NAME", that of another process,
 * with TEGOTAE_CLOCK_REAL; or NULL: a simulated pen, whose hand tegotae_rig_lead() leads, from where the held part
 * starts. */
TEGOTAE_C_EXPORT tegotae_rig* tegotae_rig_create(const tegotae_scene* scene, const char* device, int clock);
/** Stops. NULL is let be. */
TEGOTAE_C_EXPORT void tegotae_rig_destroy(tegotae_rig* rig);
/** Starts pen and servo. */
TEGOTAE_C_EXPORT int tegotae_rig_start(tegotae_rig* rig);
/** One step of the contact loop; what it did, unless `tick` is NULL. */
TEGOTAE_C_EXPORT int tegotae_rig_step(tegotae_rig* rig, struct tegotae_tick* tick);
/** Stops pen and servo. */
TEGOTAE_C_EXPORT int tegotae_rig_stop(tegotae_rig* rig);
/** The contacts of the last step, at most `capacity` of them; returns how many there are. */
TEGOTAE_C_EXPORT int64_t tegotae_rig_contacts(const tegotae_rig* rig, struct tegotae_contact* contacts,
                                              size_t capacity);
/** Where the held part is, from any thread. */
TEGOTAE_C_EXPORT int tegotae_rig_part(const tegotae_rig* rig, double pose[7]);
/** The simulated hand shall carry the held part to `pose`, as fast as a hand can; from any thread. */
TEGOTAE_C_EXPORT int tegotae_rig_lead(tegotae_rig* rig, const double pose[7]);
/** Continues in the scene as it is now; the part that is held goes on from where it is. From any thread. Waits for at
 * most `seconds` until it is so, for which another thread must step the rig; then the change is taken back, and the
 * call fails. With 0 seconds it does not wait, and the change comes into force when it can. */
TEGOTAE_C_EXPORT int tegotae_rig_change(tegotae_rig* rig, const tegotae_scene* scene, double seconds);

#ifdef __cplusplus
}
#endif

#endif
