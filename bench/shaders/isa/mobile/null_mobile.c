/* A GPU of a phone or a small board that is not there: as much of Linux's msm and v3d drivers as Mesa's turnip and v3dv ask
   for before they compile.

   Loaded by LD_PRELOAD into the process that compiles, and into no other. It answers in the kernel's place, so nothing is
   ever drawn.

   NORMALBENCH_NULL_MOBILE is "msm GPU CHIP", numbers as the msm driver has them, or "v3d", which is V3D 4.2. Without it
   there is no device.

   Structures and numbers are those of the kernel's include/uapi/drm/msm_drm.h and v3d_drm.h; V3D 4.2's registers as Mesa's
   own null device has them (src/broadcom/drm-shim/v3d_noop.c). */
#include "null_drm.h"

static const uint64_t MIB = 1ull << 20, GIB = 1ull << 30;

/* msm's requests; what is not answered here succeeds and does nothing. */
enum { MSM_GET_PARAMETER = 0x00, MSM_CREATE = 0x02, MSM_INFO = 0x03, MSM_ADVISE = 0x08, MSM_QUEUE = 0x0a };
struct msm_parameter { uint32_t pipe, name; uint64_t value; uint32_t length, pad; };
struct msm_object { uint64_t size; uint32_t flags, handle; };
struct msm_info { uint32_t handle, name; uint64_t value; uint32_t length, pad; };
struct msm_advice { uint32_t handle, advice, retained; };
struct msm_queue { uint32_t flags, priority, id; };
_Static_assert(sizeof(struct msm_parameter) == 24 && sizeof(struct msm_info) == 24, "msm_drm.h");

/* v3d's. */
enum { V3D_CREATE = 0x02, V3D_MAP = 0x03, V3D_GET_PARAMETER = 0x04 };
struct v3d_object { uint32_t size, flags, handle, offset; };
struct v3d_mapping { uint32_t handle, flags; uint64_t offset; };
struct v3d_parameter { uint32_t name, pad; uint64_t value; };
_Static_assert(sizeof(struct v3d_object) == 16 && sizeof(struct v3d_parameter) == 16, "v3d_drm.h");

static unsigned gpu, chip;

static int is_msm(void) {
  const char *said = getenv("NORMALBENCH_NULL_MOBILE");
  return said && sscanf(said, "msm %i %i", (int *)&gpu, (int *)&chip) == 2;
}

static int has_gpu(void) {
  const char *said = getenv("NORMALBENCH_NULL_MOBILE");
  return is_msm() || (said && strcmp(said, "v3d") == 0);
}

/* v3dv looks for what draws and for what shows it, by the names in the device tree. */
static int list_gpu(struct drm_device *all[MOST]) {
  static char *draws[] = {"brcm,2711-v3d", NULL}, *shows[] = {"brcm,bcm2711-vc5", NULL}, *adreno[] = {"qcom,adreno", NULL};
  static struct platform_names names[] = {{draws}, {shows}, {adreno}};
  static struct drm_device devices[] = {
    {DRM_NODES, 1 << RENDER_NODE, PLATFORM, "", &names[0]},
    {DRM_NODES, 1 << PRIMARY_NODE, PLATFORM, "", &names[1]},
    {DRM_NODES, 1 << RENDER_NODE, PLATFORM, "", &names[2]},
  };
  if (is_msm()) { all[0] = &devices[2]; return 1; }
  all[0] = &devices[0], all[1] = &devices[1];
  return 2;
}

/* What is not a number here is a count or a feature: 1. */
static uint64_t msm_value(unsigned name) {
  switch (name) {
  case 0x01: return gpu;
  case 0x02: return MIB; /* GMEM_SIZE */
  case 0x03: return chip;
  case 0x04: return 1000000; /* MAX_FREQ */
  case 0x06: return MIB; /* GMEM_BASE */
  case 0x0e: case 0x0f: return 4 * GIB; /* VA_START, VA_SIZE */
  default: return 1;
  }
}

/* Objects lie one after the other in the GPU's address space. */
static uint64_t address_of(uint64_t handle) { return 4 * GIB + handle * 64 * MIB; }

static int answer_msm(unsigned request, void *given) {
  static uint32_t handle = 1;
  switch (request) {
  case MSM_GET_PARAMETER: ((struct msm_parameter *)given)->value = msm_value(((struct msm_parameter *)given)->name); break;
  case MSM_CREATE: ((struct msm_object *)given)->handle = handle++; break;
  case MSM_ADVISE: ((struct msm_advice *)given)->retained = 1; break;
  case MSM_QUEUE: ((struct msm_queue *)given)->id = 1; break;
  case MSM_INFO: {
    struct msm_info *asked = given;
    if (asked->name < 2) asked->value = asked->name ? address_of(asked->handle) : 4096; /* GET_OFFSET, GET_IOVA */
  }
  }
  return 0;
}

static uint64_t v3d_value(unsigned name) {
  static const uint32_t registers[] = {0x45, 0x000e1124, 0x100, 0xe00, 0x04443356, 0x81001422, 0x40078121};
  return name < sizeof registers / sizeof *registers ? registers[name] : 1;
}

static int answer_v3d(unsigned request, void *given) {
  static uint32_t handle = 1, offset = 0x1000;
  switch (request) {
  case V3D_GET_PARAMETER: ((struct v3d_parameter *)given)->value = v3d_value(((struct v3d_parameter *)given)->name); break;
  case V3D_MAP: ((struct v3d_mapping *)given)->offset = 0; break;
  case V3D_CREATE: {
    struct v3d_object *asked = given;
    asked->handle = handle++, asked->offset = offset, offset += asked->size;
  }
  }
  return 0;
}

static int answer(unsigned request, void *given) {
  static uint32_t sync = 1;
  /* msm 1.9 tells turnip what the kernel can. */
  if (request == GET_VERSION) return is_msm() ? tell_version(given, 1, 9, "msm") : tell_version(given, 1, 0, "v3d");
  if (request == GET_CAPABILITY) ((struct capability *)given)->value = 1;
  if (request == SYNC_CREATE) *(uint32_t *)given = sync++;
  if (request < COMMANDS || request >= COMMANDS + 0x60) return 0;
  return is_msm() ? answer_msm(request - COMMANDS, given) : answer_v3d(request - COMMANDS, given);
}

/* turnip takes no offset of 0 for memory to be mapped at, and what lies behind it in NODE cannot be touched. */
#define MAPPING(name)                                                                          \
  void *name(void *at, size_t length, int protection, int flags, int file, off_t offset) {    \
    static void *(*real)(void *, size_t, int, int, int, off_t);                                \
    if (!real) real = (void *(*)(void *, size_t, int, int, int, off_t))dlsym(RTLD_NEXT, #name); \
    return real(at, length, protection, flags, file, file >= 0 && is_own(file) ? 0 : offset);  \
  }
MAPPING(mmap)
MAPPING(mmap64)
