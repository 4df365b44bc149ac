#include "shm_reader.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

static struct tegotae_shm_segment* map(const char* name) {
  const int fd = shm_open(name, O_RDWR, 0);
  if (fd < 0) return NULL;
  void* memory = mmap(NULL, sizeof(struct tegotae_shm_segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  return memory == MAP_FAILED ? NULL : memory;
}

int c_read_device(const char* name, struct tegotae_shm_device* payload) {
  struct tegotae_shm_segment* segment = map(name);
  if (segment == NULL) return 0;
  const int whole = tegotae_shm_read(&segment->device_counter, segment->device, payload, sizeof *payload);
  munmap(segment, sizeof *segment);
  return whole;
}

int c_write_application(const char* name, const struct tegotae_shm_application* payload) {
  struct tegotae_shm_segment* segment = map(name);
  if (segment == NULL) return 0;
  tegotae_shm_write(&segment->application_counter, segment->application, payload, sizeof *payload);
  munmap(segment, sizeof *segment);
  return 1;
}
