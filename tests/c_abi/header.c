/* The header alone, as C99 to C17 and C++11 to C++20: twice, and every constant in an expression. */
#include "hbvib.h"
#include "hbvib.h"

#if HBVIB_VERSION_NUMBER != HBVIB_VERSION_MAJOR * 65536 + HBVIB_VERSION_MINOR * 256 + HBVIB_VERSION_PATCH
#error "the number of the version is that of its parts"
#endif

int32_t header_check(int32_t status);
HBVIB_DEPRECATED("of the next version") int32_t header_deprecated(void);

/* Negative constants bind as numbers do. */
int32_t header_check(int32_t status)
{
    hbvib_contact contact;
    hbvib_hooks hooks;
    hbvib_energy energy;
    hbvib_mode_options mode;
    hbvib_mode_info info;
    hbvib_cancel_flag flag = 0;
    contact.struct_size = (uint32_t)sizeof contact;
    contact.dof_a[0] = 3 - HBVIB_GROUND;
    contact.kind = HBVIB_JENKINS;
    mode.damping_form = HBVIB_DAMPING_STIFFNESS - HBVIB_DAMPING_MASS;
    info.multiple = mode.damping_form + HBVIB_MODE_TRAVELLING_WAVE + HBVIB_MODE_PROJECTED - HBVIB_MODE_FIRST;
    hooks.cancel = &flag;
    flag = 1;
    energy.friction_loss = 0;
    if (energy.friction_loss > 1) return -1;
    switch (status) {
    case HBVIB_OK: return (int32_t)contact.dof_a[0];
    case HBVIB_MODAL_ASSURANCE: return info.multiple - HBVIB_MODE_SINGLE;
    case HBVIB_E_NULL: return 2 * HBVIB_E_NULL;
    case HBVIB_E_INTERNAL: return 1 - HBVIB_E_INTERNAL;
    case HBVIB_STOPPED_BY_CALLER: return *hooks.cancel + (int32_t)contact.struct_size + contact.kind;
    default: return status < HBVIB_OK ? -HBVIB_E_NULL : HBVIB_VERSION_MAJOR + HBVIB_VERSION_MINOR + HBVIB_VERSION_PATCH;
    }
}
