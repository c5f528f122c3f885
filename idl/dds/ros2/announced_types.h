// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

/* Access to the globals of a Cyclone domain, whose header works in C only. */

#ifdef __cplusplus
extern "C" {
#endif

/* The types with which a domain announces its writers and its readers. */
struct cohort_announced_types {
  struct ddsi_sertype* writers;
  struct ddsi_sertype* readers;
};

/* Returns the types of the domain in which a type is registered. */
struct cohort_announced_types cohort_announced_types_of(const struct ddsi_sertype* registered);

#ifdef __cplusplus
}
#endif
