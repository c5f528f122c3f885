// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/endpoint_owners.hpp"

#include <dds/ddsi/ddsi_plist.h>
#include <dds/ddsi/ddsi_serdata_plist.h>

#include <atomic>

#include "idl/dds/ros2/announced_types.h"

namespace cohort::ros2 {
namespace {

// Cyclone identifies received data by its operations, but keeps the type's operations for data that it sends, because
// it searches for samples with equal operations.
ddsi_serdata* as_received(ddsi_serdata* made) {
  if (made != nullptr) made->ops = &ddsi_serdata_ops_plist;
  return made;
}

ddsi_serdata* read_announcement(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragments,
                                std::size_t size) {
  return as_received(ddsi_serdata_ops_plist.from_ser(type, kind, fragments, size));
}

ddsi_serdata* read_announcement_key(const ddsi_sertype* type, const ddsi_keyhash* hash) {
  return as_received(ddsi_serdata_ops_plist.from_keyhash(type, hash));
}

ddsi_serdata* make_announcement(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  ddsi_plist_t parameters = *static_cast<const ddsi_plist_t*>(sample);  // does not own the data that it points to
  if (kind == SDK_DATA) {
    parameters.present |= PP_PARTICIPANT_GUID;
    parameters.participant_guid = parameters.endpoint_guid;
    parameters.participant_guid.entityid.u = NN_ENTITYID_PARTICIPANT;
  }
  return ddsi_serdata_ops_plist.from_sample(type, kind, &parameters);
}

const ddsi_serdata_ops& announcement_operations() {
  static const ddsi_serdata_ops operations = [] {
    ddsi_serdata_ops made = ddsi_serdata_ops_plist;
    made.from_ser = read_announcement;
    made.from_keyhash = read_announcement_key;
    made.from_sample = make_announcement;
    return made;
  }();
  return operations;
}

}  // namespace

void announce_owners(const OpaqueTopic& topic) {
  const auto [writers, readers] = cohort_announced_types_of(topic.type());
  for (ddsi_sertype* type : {writers, readers}) {
    const std::atomic_ref operations(type->serdata_ops);  // used by the domain's threads
    if (operations.load() == &ddsi_serdata_ops_plist) operations.store(&announcement_operations());
  }
}

}  // namespace cohort::ros2
