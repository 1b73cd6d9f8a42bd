/* A GPU that is not there, as libdrm lists it, in the process that loads it and in no other.

   null_i915.c defines has_gpu, list_gpu and answer. It works on its own file alone: DRM requests on any other file, and the
   opening of any other DRM device, fail with ENODEV and never reach the kernel.

   Structures and numbers are those of the kernel's include/uapi/drm/drm.h and of libdrm's xf86drm.h, written out so that
   no header of theirs is needed. */
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
struct drm_device { char **nodes; int available_nodes, bus; void *place, *names; };
enum { NODES = 3, RENDER_NODE = 2, PCI = 0, MOST = 1 };

/* DRM's own requests; a driver's begin at COMMANDS. */
enum { GET_CAPABILITY = 0x0c, SYNC_CREATE = 0xbf, COMMANDS = 0x40 };
struct capability { uint64_t name, value; };

/* Reading and mapping it gives zeros, as memory that was just allocated does. */
static char NODE[] = "/dev/zero";
static char *DRM_NODES[NODES] = {NODE, NODE, NODE};

/* Whether the environment names a GPU. */
static int has_gpu(void);
/* What libdrm lists of it, the one that renders first: how many. */
static int list_gpu(struct drm_device *all[MOST]);
/* A request in the kernel's place: 0, or -1 and errno. */
static int answer(unsigned request, void *given);

/* Whether a file is the null device's. */
static int is_own(int file) {
  struct stat about;
  return fstat(file, &about) == 0 && S_ISCHR(about.st_mode) && about.st_rdev == makedev(1, 5);
}

static int refused(int why) { errno = why; return -1; }

/* A GPU on the PCI bus. */
static inline struct drm_device *pci_gpu(unsigned vendor, unsigned device, unsigned revision) {
  static struct pci_place place = {0, 0, 2, 0};
  static struct pci_names names;
  static struct drm_device found = {DRM_NODES, 1 << RENDER_NODE, PCI, &place, &names};
  names.vendor = vendor, names.device = device, names.revision = revision;
  return &found;
}

int drmGetDevices2(uint32_t flags, struct drm_device **devices, int most) {
  struct drm_device *all[MOST];
  int count = has_gpu() ? list_gpu(all) : 0;
  for (int i = 0; devices && i < count && i < most; i++) devices[i] = all[i];
  return count;
}

int drmGetDevice2(int file, uint32_t flags, struct drm_device **device) {
  if (!has_gpu() || !is_own(file)) return -ENODEV;
  return drmGetDevices2(flags, device, 1) ? 0 : -ENODEV;
}

int drmGetDevices(struct drm_device **devices, int most) { return drmGetDevices2(0, devices, most); }
int drmGetDevice(int file, struct drm_device **device) { return drmGetDevice2(file, 0, device); }
void drmFreeDevice(struct drm_device **device) { *device = NULL; }
void drmFreeDevices(struct drm_device **devices, int count) { memset(devices, 0, count * sizeof *devices); }

int ioctl(int file, unsigned long request, ...) {
  static int (*real)(int, unsigned long, ...);
  va_list words;
  va_start(words, request);
  void *given = va_arg(words, void *);
  va_end(words);
  if (_IOC_TYPE(request) == 'd') return has_gpu() && is_own(file) ? answer(_IOC_NR(request), given) : refused(ENODEV);
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
    if (is_device(path)) return refused(ENODEV);                           \
    if (!real) real = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, #name); \
    return real(path, flags, mode);                                        \
  }
OPENING(open)
OPENING(open64)
