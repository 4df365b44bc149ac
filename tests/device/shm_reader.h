#pragma once

#include "tegotae/device/shm.h"

#ifdef __cplusplus
extern "C" {
#endif
/* What a program in C does with the protocol's header alone: maps the segment and reads or writes a slot.
 * 1 when it worked. */
int c_read_device(const char* name, struct tegotae_shm_device* payload);
int c_write_application(const char* name, const struct tegotae_shm_application* payload);
#ifdef __cplusplus
}
#endif
