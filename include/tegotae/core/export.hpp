#pragma once

/// @namespace tegotae
/// The library. SI units everywhere: m, kg, s, N, N·m, rad. `X_WF` is the pose of frame F in the world W. `p_WA` is a
/// point A, and `n_BA_W` a unit normal from B to A; both are expressed in W. A part's *file frame* is that of its mesh
/// file. *X*, the proxy, is the pose of the held part; *Y* is the pose where the pen wants it. *The paper* is T.
/// Yokoyama and Y. Iida, "Research on Haptic Display of Rigid Body Simulation for Digital Mock-Up".

/// Marks what the shared library exports. Every public header opens `namespace tegotae TEGOTAE_EXPORT {`, which exports
/// the declarations of that block. All other code is compiled with hidden visibility.
#define TEGOTAE_EXPORT __attribute__((visibility("default")))
