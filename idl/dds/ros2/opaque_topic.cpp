// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/opaque_topic.hpp"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace cohort::ros2 {
namespace {

// A sample: its bytes, padded to a multiple of four as RTPS requires.
struct Sample : ddsi_serdata {
  Sample(const ddsi_sertype* its_type, ddsi_serdata_kind its_kind, std::size_t size) : ddsi_serdata{} {
    ddsi_serdata_init(this, its_type, its_kind);
    bytes.resize((size + 3) & ~std::size_t{3});
  }
  std::vector<std::byte> bytes{};
};

const Sample& sample_of(const ddsi_serdata* data) { return *static_cast<const Sample*>(data); }

// Creates a sample. Exceptions must not pass through Cyclone, which is C; null means that there is no memory.
ddsi_serdata* make_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) noexcept {
  try {
    return new Sample(type, kind, size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void copy(ddsi_serdata* to, std::size_t at, const void* from, std::size_t size) noexcept {
  std::memcpy(static_cast<Sample*>(to)->bytes.data() + at, from, size);
}

bool have_equal_keys(const ddsi_serdata*, const ddsi_serdata*) { return true; }
std::uint32_t size_of(const ddsi_serdata* data) { return static_cast<std::uint32_t>(sample_of(data).bytes.size()); }

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  ddsi_serdata* sample = make_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  for (std::uint32_t at = 0; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= at) continue;  // a duplicate
    const unsigned char* const payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    copy(sample, at, payload + (at - fragment->min), fragment->maxp1 - at);
    at = fragment->maxp1;
  }
  return sample;
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  ddsi_serdata* sample = make_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  std::size_t at = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && at < size; ++i) {
    const std::size_t part = std::min<std::size_t>(parts[i].iov_len, size - at);
    copy(sample, at, parts[i].iov_base, part);
    at += part;
  }
  return sample;
}

ddsi_serdata* from_key_hash(const ddsi_sertype* type, const ddsi_keyhash*) { return make_sample(type, SDK_KEY, 0); }

ddsi_serdata* from_bytes(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* given) {
  const auto& bytes = *static_cast<const std::span<const std::byte>*>(given);
  ddsi_serdata* sample = make_sample(type, kind, bytes.size());
  if (sample != nullptr && !bytes.empty()) copy(sample, 0, bytes.data(), bytes.size());
  return sample;
}

void copy_out(const ddsi_serdata* data, std::size_t from, std::size_t size, void* to) {
  std::memcpy(to, sample_of(data).bytes.data() + from, size);
}

ddsi_serdata* lend(const ddsi_serdata* data, std::size_t from, std::size_t size, ddsrt_iovec_t* lent) {
  lent->iov_base = const_cast<std::byte*>(sample_of(data).bytes.data()) + from;
  lent->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(data);
}
void take_back(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

// Refuses conversion: samples are read only as serialized data.
bool to_sample(const ddsi_serdata*, void*, void**, void*) { return false; }
bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return false; }

ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  ddsi_serdata* key = make_sample(data->type, SDK_KEY, 0);
  if (key != nullptr) key->type = nullptr;
  return key;
}
void free_sample(ddsi_serdata* data) { delete static_cast<Sample*>(data); }
std::size_t print(const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t size) {
  if (size > 0) *text = '\0';
  return 0;
}
void key_hash(const ddsi_serdata*, ddsi_keyhash* hash, bool) { std::memset(hash, 0, sizeof *hash); }

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}
void zero_samples(const ddsi_sertype*, void*, std::size_t) {}
void reallocate_samples(void** pointers, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) pointers[i] = nullptr;
}
void free_samples(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}
// Considers types equal if they have the same name: Cyclone compares the names itself.
bool are_equal(const ddsi_sertype*, const ddsi_sertype*) { return true; }
std::uint32_t type_hash(const ddsi_sertype*) { return 0; }

const ddsi_serdata_ops& sample_operations() {
  static const ddsi_serdata_ops operations = [] {
    ddsi_serdata_ops made{};  // the omitted members are for iceoryx
    made.eqkey = have_equal_keys;
    made.get_size = size_of;
    made.from_ser = from_fragments;
    made.from_ser_iov = from_parts;
    made.from_keyhash = from_key_hash;
    made.from_sample = from_bytes;
    made.to_ser = copy_out;
    made.to_ser_ref = lend;
    made.to_ser_unref = take_back;
    made.to_sample = to_sample;
    made.to_untyped = to_untyped;
    made.untyped_to_sample = untyped_to_sample;
    made.free = free_sample;
    made.print = print;
    made.get_keyhash = key_hash;
    return made;
  }();
  return operations;
}

const ddsi_sertype_ops& type_operations() {
  static const ddsi_sertype_ops operations = [] {
    ddsi_sertype_ops made{};  // without type information, peers compare names
    made.version = ddsi_sertype_v0;
    made.free = free_type;
    made.zero_samples = zero_samples;
    made.realloc_samples = reallocate_samples;
    made.free_samples = free_samples;
    made.equal = are_equal;
    made.hash = type_hash;
    return made;
  }();
  return operations;
}

}  // namespace

OpaqueTopic::OpaqueTopic(dds_entity_t participant, const std::string& name, const std::string& type) {
  auto* made = new ddsi_sertype{};
  ddsi_sertype_init(made, type.c_str(), &type_operations(), &sample_operations(), true);
  made->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  const dds_entity_t handle = dds_create_topic_sertype(participant, name.c_str(), &made, nullptr, nullptr, nullptr);
  if (handle < 0) ddsi_sertype_unref(made);
  topic_ = wire::Entity(wire::check(handle, "create the topic", name.c_str()));
  type_ = made;
}

bool OpaqueTopic::write(dds_entity_t writer, std::span<const std::byte> bytes) const {
  ddsi_serdata* const sample = from_bytes(type_, SDK_DATA, &bytes);
  if (sample == nullptr) throw std::bad_alloc();
  const dds_return_t result = dds_writecdr(writer, sample);
  if (result == DDS_RETCODE_TIMEOUT) return false;
  wire::check(result, "write", "a message");
  return true;
}

void take_opaque(dds_entity_t reader, const std::function<void(const OpaqueSample& sample)>& take) {
  std::array<ddsi_serdata*, 16> samples{};
  std::array<dds_sample_info_t, 16> infos{};
  for (;;) {
    const dds_return_t count = dds_takecdr(reader, samples.data(), samples.size(), infos.data(), DDS_ANY_STATE);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) take({sample_of(samples[i]).bytes, infos[i].publication_handle});
      ddsi_serdata_unref(samples[i]);
    }
  }
}

}  // namespace cohort::ros2
