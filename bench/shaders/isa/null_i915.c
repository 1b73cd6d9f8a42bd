/* An Intel GPU that is not there: as much of Linux's i915 driver as Mesa's Vulkan drivers ask for before they compile.

   Loaded by LD_PRELOAD into the process that compiles, and into no other. It answers in the kernel's place, so nothing is
   ever drawn.

   NORMALBENCH_NULL_I915 is "PCI REVISION SLICES SUBSLICES EUS LOCAL": numbers, where LOCAL is 1 for a GPU with memory of
   its own. Without it there is no device.

   Structures and numbers are those of the kernel's include/uapi/drm/i915_drm.h. */
#include "null_drm.h"

/* i915's requests. */
enum {
  GET_PARAMETER = 0x06, CREATE = 0x1b, MAP = 0x1e, GET_TILING = 0x22, GET_APERTURE = 0x23, MAP_OFFSET = 0x24,
  CONTEXT_CREATE = 0x2d, USER_POINTER = 0x33, CONTEXT_GET = 0x34, QUERY = 0x39, VM_CREATE = 0x3a, CREATE_EXTENDED = 0x3c
};
struct sync { uint32_t handle, flags; };
struct parameter { int32_t name; int *value; };
/* `create` and `create_ext` begin alike. */
struct object { uint64_t size; uint32_t handle, flags; };
struct user_pointer { uint64_t pointer, size; uint32_t flags, handle; };
struct mapping { uint32_t handle, pad; uint64_t offset, size, address, flags; };
struct mapping_offset { uint32_t handle, pad; uint64_t offset, flags, extensions; };
struct context { uint32_t id, pad; };
struct context_parameter { uint32_t id, size; uint64_t name, value; };
struct address_space { uint64_t extensions; uint32_t flags, id; };
struct aperture { uint64_t size, available; };
struct tiling { uint32_t handle, mode, swizzle, physical; };
struct query { uint32_t count, flags; uint64_t items; };
struct query_item { uint64_t name; int32_t length; uint32_t flags; uint64_t data; };
enum { TOPOLOGY = 1, ENGINES = 2, REGIONS = 4, GEOMETRY = 6 };
struct topology {
  uint16_t flags, slices, subslices, eus, subslice_offset, subslice_stride, eu_offset, eu_stride;
  uint8_t data[];
};
struct engine { uint16_t class, instance; uint32_t pad; uint64_t flags, capabilities; uint16_t logical, pads[3]; uint64_t more[3]; };
struct engines { uint32_t count, pads[3]; struct engine all[]; };
struct region { uint16_t class, instance; uint32_t pad; uint64_t size, unallocated, more[8]; };
struct regions { uint32_t count, pads[3]; struct region all[]; };
_Static_assert(sizeof(struct topology) == 16 && sizeof(struct engine) == 56 && sizeof(struct region) == 88, "i915_drm.h");
_Static_assert(sizeof(struct mapping) == 40 && sizeof(struct query_item) == 24, "i915_drm.h");

static const uint64_t GIB = 1ull << 30;
static struct gpu { unsigned pci, revision, slices, subslices, eus, local; } gpu;

static int has_gpu(void) {
  const char *said = getenv("NORMALBENCH_NULL_I915");
  return said && sscanf(said, "%i %u %u %u %u %u", (int *)&gpu.pci, &gpu.revision, &gpu.slices, &gpu.subslices, &gpu.eus,
                        &gpu.local) == 6;
}

static int list_gpu(struct drm_device *all[MOST]) {
  enum { VENDOR_INTEL = 0x8086 };
  all[0] = pci_gpu(VENDOR_INTEL, gpu.pci, gpu.revision);
  return 1;
}

static void set(uint8_t *mask, unsigned bit) { mask[bit / 8] |= 1u << bit % 8; }

/* A query is asked twice: for its length, and then for its data. */
static void *to_fill(struct query_item *item, size_t length) {
  if (item->length == 0) { item->length = (int32_t)length; return NULL; }
  if (item->length < (int32_t)length) { item->length = -EINVAL; return NULL; }
  return memset((void *)(uintptr_t)item->data, 0, length);
}

/* Every slice, subslice and execution unit is there. */
static void tell_topology(struct query_item *item) {
  unsigned slices = (gpu.slices + 7) / 8, subslices = (gpu.subslices + 7) / 8, eus = (gpu.eus + 7) / 8;
  unsigned all = gpu.slices * gpu.subslices;
  struct topology *t = to_fill(item, sizeof *t + slices + gpu.slices * subslices + all * eus);
  if (!t) return;
  t->slices = gpu.slices, t->subslices = gpu.subslices, t->eus = gpu.eus;
  t->subslice_offset = slices, t->subslice_stride = subslices;
  t->eu_offset = slices + gpu.slices * subslices, t->eu_stride = eus;
  for (unsigned i = 0; i < gpu.slices; i++) set(t->data, i);
  for (unsigned i = 0; i < all; i++)
    set(t->data + t->subslice_offset + i / gpu.subslices * subslices, i % gpu.subslices);
  for (unsigned i = 0; i < all * gpu.eus; i++) set(t->data + t->eu_offset + i / gpu.eus * eus, i % gpu.eus);
}

/* One that draws and one that copies. */
static void tell_engines(struct query_item *item) {
  struct engines *e = to_fill(item, sizeof *e + 2 * sizeof e->all[0]);
  if (!e) return;
  e->count = 2, e->all[1].class = 1;
}

static void tell_regions(struct query_item *item) {
  unsigned count = gpu.local ? 2 : 1;
  struct regions *r = to_fill(item, sizeof *r + count * sizeof r->all[0]);
  if (!r) return;
  r->count = count;
  for (unsigned i = 0; i < count; i++) r->all[i].class = i, r->all[i].size = r->all[i].unallocated = 4 * GIB;
}

static int tell(struct query *query) {
  struct query_item *items = (void *)(uintptr_t)query->items;
  for (unsigned i = 0; i < query->count; i++) switch (items[i].name & 0xff) {
    case TOPOLOGY: case GEOMETRY: tell_topology(&items[i]); break;
    case ENGINES: tell_engines(&items[i]); break;
    case REGIONS: tell_regions(&items[i]); break;
    default: items[i].length = -EINVAL;
  }
  return 0;
}

/* What is not a number here is a feature, and every feature is there. */
static int value_of(int parameter) {
  switch (parameter) {
  case 4: return gpu.pci;
  case 18: return 3; /* HAS_ALIASING_PPGTT: full address spaces, of 48 bits */
  case 28: return 10; /* CMD_PARSER_VERSION */
  case 30: case 40: return 4; /* MMAP_VERSION, MMAP_GTT_VERSION */
  case 32: return gpu.revision;
  case 33: return gpu.slices * gpu.subslices;
  case 34: return gpu.slices * gpu.subslices * gpu.eus;
  case 51: return 12000000; /* CS_TIMESTAMP_FREQUENCY */
  case 54: return 0; /* PERF_REVISION: no counters */
  default: return 1;
  }
}

static int answer(unsigned request, void *given) {
  static uint32_t handle = 1;
  if (request == GET_CAPABILITY) ((struct capability *)given)->value = 1;
  if (request == SYNC_CREATE) ((struct sync *)given)->handle = handle++;
  switch (request - COMMANDS) {
  case GET_PARAMETER: *((struct parameter *)given)->value = value_of(((struct parameter *)given)->name); break;
  case QUERY: return tell(given);
  case CREATE: case CREATE_EXTENDED: ((struct object *)given)->handle = handle++; break;
  case USER_POINTER: ((struct user_pointer *)given)->handle = handle++; break;
  case MAP_OFFSET: ((struct mapping_offset *)given)->offset = 0; break;
  case CONTEXT_CREATE: ((struct context *)given)->id = 1; break;
  case VM_CREATE: ((struct address_space *)given)->id = 1; break;
  case GET_APERTURE: *(struct aperture *)given = (struct aperture){1ull << 48, 1ull << 48}; break;
  case GET_TILING: ((struct tiling *)given)->mode = ((struct tiling *)given)->swizzle = 0; break;
  case CONTEXT_GET: {
    struct context_parameter *asked = given;
    asked->value = asked->name == 3 ? 1ull << 48 : 0; /* CONTEXT_PARAM_GTT_SIZE */
    break;
  }
  case MAP: {
    struct mapping *asked = given;
    void *made = mmap(NULL, asked->size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (made == MAP_FAILED) return -1;
    asked->address = (uintptr_t)made;
  }
  }
  return 0;
}
