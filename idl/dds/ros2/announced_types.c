// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/announced_types.h"

#include <dds/ddsi/ddsi_domaingv.h>

struct cohort_announced_types cohort_announced_types_of(const struct ddsi_sertype* registered) {
  const struct ddsi_domaingv* const domain = ddsrt_atomic_ldvoidp(&registered->gv);
  const struct cohort_announced_types types = {domain->sedp_writer_type, domain->sedp_reader_type};
  return types;
}
