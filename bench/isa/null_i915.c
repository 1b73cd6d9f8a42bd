/* An Intel GPU that is not there: as much of Linux's i915 driver as Mesa's Vulkan drivers ask for before they compile.

   Loaded by LD_PRELOAD into the process that compiles, and into no other. It answers in the kernel's place, so nothing is
   ever drawn. It works on its own file alone: DRM requests on any other file, and the opening of any other DRM device,
   fail with ENODEV and never reach the kernel.

   NORMALBENCH_NULL_I915 is "PCI REVISION SLICES SUBSLICES EUS LOCAL": numbers, where LOCAL is 1 for a GPU with memory of
   its own. Without it there is no device.

   Structures and numbers are those of the kernel's include/uapi/drm/drm.h and i915_drm.h, and of libdrm's xf86drm.h,
   written out so that no header of theirs is needed. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

/* libdrm's devices. */
struct pci_place { uint16_t domain; uint8_t bus, device, function; };
struct pci_names { uint16_t vendor, device, subvendor, subdevice; uint8_t revision; };
struct drm_device { char **nodes; int available_nodes, bus; struct pci_place *place; struct pci_names *names; };
enum { NODES = 3, RENDER_NODE = 2, VENDOR_INTEL = 0x8086 };

/* Requests: DRM's own, then i915's, which begin at COMMANDS. */
enum { GET_CAPABILITY = 0x0c, SYNC_CREATE = 0xbf, COMMANDS = 0x40 };
enum {
  GET_PARAMETER = 0x06, CREATE = 0x1b, MAP = 0x1e, GET_TILING = 0x22, GET_APERTURE = 0x23, MAP_OFFSET = 0x24,
  CONTEXT_CREATE = 0x2d, USER_POINTER = 0x33, CONTEXT_GET = 0x34, QUERY = 0x39, VM_CREATE = 0x3a, CREATE_EXTENDED = 0x3c
};
struct capability { uint64_t name, value; };
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
/* Reading and mapping it gives zeros, as memory that was just allocated does. */
static char NODE[] = "/dev/zero";

static struct gpu { unsigned pci, revision, slices, subslices, eus, local; } gpu;

static int has_gpu(void) {
  const char *said = getenv("NORMALBENCH_NULL_I915");
  return said && sscanf(said, "%i %u %u %u %u %u", (int *)&gpu.pci, &gpu.revision, &gpu.slices, &gpu.subslices, &gpu.eus,
                        &gpu.local) == 6;
}

/* Whether a file is the null device's. */
static int is_own(int file) {
  struct stat about;
  return fstat(file, &about) == 0 && S_ISCHR(about.st_mode) && about.st_rdev == makedev(1, 5);
}

static int refused(void) { errno = ENODEV; return -1; }

static struct drm_device *the_device(void) {
  static char *nodes[NODES] = {NODE, NODE, NODE};
  static struct pci_place place = {0, 0, 2, 0};
  static struct pci_names names;
  static struct drm_device device = {nodes, 1 << RENDER_NODE, 0, &place, &names};
  names.vendor = VENDOR_INTEL, names.device = gpu.pci, names.revision = gpu.revision;
  return &device;
}

int drmGetDevices2(uint32_t flags, struct drm_device **devices, int most) {
  if (!has_gpu()) return 0;
  if (devices && most > 0) devices[0] = the_device();
  return 1;
}

int drmGetDevice2(int file, uint32_t flags, struct drm_device **device) {
  if (!has_gpu() || !is_own(file)) return -ENODEV;
  *device = the_device();
  return 0;
}

int drmGetDevices(struct drm_device **devices, int most) { return drmGetDevices2(0, devices, most); }
int drmGetDevice(int file, struct drm_device **device) { return drmGetDevice2(file, 0, device); }
void drmFreeDevice(struct drm_device **device) { *device = NULL; }
void drmFreeDevices(struct drm_device **devices, int count) { memset(devices, 0, count * sizeof *devices); }

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

int ioctl(int file, unsigned long request, ...) {
  static int (*real)(int, unsigned long, ...);
  va_list words;
  va_start(words, request);
  void *given = va_arg(words, void *);
  va_end(words);
  if (_IOC_TYPE(request) == 'd') return has_gpu() && is_own(file) ? answer(_IOC_NR(request), given) : refused();
  if (!real) real = (int (*)(int, unsigned long, ...))dlsym(RTLD_NEXT, "ioctl");
  return real(file, request, given);
}

static int is_device(const char *path) { return path && strncmp(path, "/dev/dri", 8) == 0; }

#define OPENING(name)                                                      \
  int name(const char *path, int flags, ...) {                             \
    static int (*real)(const char *, int, ...);                            \
    va_list words;                                                         \
    va_start(words, flags);                                                \
    unsigned mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(words, unsigned) : 0; \
    va_end(words);                                                         \
    if (is_device(path)) return refused();                                 \
    if (!real) real = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, #name); \
    return real(path, flags, mode);                                        \
  }
OPENING(open)
OPENING(open64)
