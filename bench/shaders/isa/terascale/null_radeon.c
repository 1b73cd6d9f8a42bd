/* A Radeon GPU of before GCN that is not there: as much of Linux's radeon driver as Mesa's r600 asks for before it
   compiles and draws.

   Loaded by LD_PRELOAD into the process that compiles, and into no other. It answers in the kernel's place, so what is
   drawn goes nowhere.

   NORMALBENCH_NULL_RADEON is the PCI device. Without it there is no device.

   Structures and numbers are those of the kernel's include/uapi/drm/drm.h and radeon_drm.h. */
#include "null_drm.h"

/* radeon's requests; what is not answered here succeeds and does nothing: submitting, waiting, tiling. */
enum { MEMORY = 0x1c, CREATE = 0x1d, MAP = 0x1e, INFO = 0x27, USER_POINTER = 0x2d };
struct memory { uint64_t shared, own, visible; };
struct object { uint64_t size, alignment; uint32_t handle, domain, flags; };
struct mapping { uint32_t handle, pad; uint64_t offset, size, address; };
struct info { uint32_t name, pad; uint64_t value; };
_Static_assert(sizeof(struct object) == 32 && sizeof(struct mapping) == 32 && sizeof(struct info) == 16, "radeon_drm.h");

static const uint64_t GIB = 1ull << 30;
static unsigned pci;

static int has_gpu(void) {
  const char *said = getenv("NORMALBENCH_NULL_RADEON");
  return said && sscanf(said, "%i", (int *)&pci) == 1;
}

static int list_gpu(struct drm_device *all[MOST]) {
  enum { VENDOR_AMD = 0x1002 };
  all[0] = pci_gpu(VENDOR_AMD, pci, 0);
  return 1;
}

/* What is not told of here is a count of units or whether something works: 1. */
static int tell(struct info *asked) {
  uint32_t *value = (void *)(uintptr_t)asked->value;
  switch (asked->name) {
  case 0x00: *value = pci; return 0;
  case 0x06: case 0x0d: *value = 0; return 0; /* TILING_CONFIG, BACKEND_MAP */
  case 0x0e: case 0x0f: return refused(EINVAL); /* VA_START, IB_VM_MAX_SIZE: no address space of its own */
  default: *value = 1; return 0;
  }
}

static int answer(unsigned request, void *given) {
  static uint32_t handle = 1;
  /* The oldest that Mesa takes. */
  if (request == GET_VERSION) return tell_version(given, 2, 50, "radeon");
  if (request == GET_CAPABILITY) ((struct capability *)given)->value = 1;
  if (request < COMMANDS) return 0;
  switch (request - COMMANDS) {
  case MEMORY: *(struct memory *)given = (struct memory){GIB, GIB, GIB}; break;
  case CREATE: ((struct object *)given)->handle = handle++; break;
  case MAP: ((struct mapping *)given)->address = 0; break;
  case INFO: return tell(given);
  case USER_POINTER: return refused(EINVAL);
  }
  return 0;
}
