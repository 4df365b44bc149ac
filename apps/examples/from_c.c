/* The library from C: a cube of 20 mm is led down onto a table, and the contacts say where it stands. */
#include <stdio.h>
#include <tegotae/tegotae.h>

static const double cube[8][3] = {{-.01, -.01, -.01}, {.01, -.01, -.01}, {-.01, .01, -.01}, {.01, .01, -.01},
                                  {-.01, -.01, .01},  {.01, -.01, .01},  {-.01, .01, .01},  {.01, .01, .01}};
static const uint32_t cube_sides[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
static const double table[4][3] = {{-.1, -.1, 0}, {.1, -.1, 0}, {.1, .1, 0}, {-.1, .1, 0}};
static const uint32_t table_top[2][3] = {{0, 1, 2}, {0, 2, 3}};

static int failed(void) {
  fprintf(stderr, "from_c: %s\n", tegotae_last_error());
  return 1;
}

int main(void) {
  const double origin[7] = {0, 0, 0, 1, 0, 0, 0}, above[7] = {0, 0, 0.015, 1, 0, 0, 0};
  const double below[7] = {0, 0, 0.005, 1, 0, 0, 0}; /* 5 mm in the table: the pen gets there, the cube does not */
  tegotae_scene* scene = tegotae_scene_create();
  if (scene == NULL || tegotae_scene_add(scene, "table", table[0], 4, table_top[0], 2, origin, 0) < 0 ||
      tegotae_scene_add(scene, "cube", cube[0], 8, cube_sides[0], 12, above, 1) < 0)
    return failed();
  tegotae_rig* rig = tegotae_rig_create(scene, NULL, TEGOTAE_CLOCK_SIMULATED);
  if (rig == NULL || tegotae_rig_start(rig) != 0 || tegotae_rig_lead(rig, below) != 0) return failed();

  struct tegotae_tick tick;
  for (int ms = 0; ms < 600; ++ms)
    if (tegotae_rig_step(rig, &tick) != 0) return failed();
  printf("cube at %.2f mm, pen at %.2f mm, %.2f N up\n", 1e3 * tick.part[2], 1e3 * tick.pen[2], tick.force[2]);

  struct tegotae_contact contacts[16];
  const int64_t count = tegotae_rig_contacts(rig, contacts, 16);
  double sum = 0;
  for (int i = 0; i < count && i < 16; ++i) sum += contacts[i].force * contacts[i].normal[2];
  printf("%d contacts with part %u carry %.2f N\n", (int)count, (unsigned)contacts[0].part, sum);
  tegotae_rig_destroy(rig);
  tegotae_scene_destroy(scene);
  return 0;
}
