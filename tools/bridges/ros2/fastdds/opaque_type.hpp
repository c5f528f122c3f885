// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <limits>
#include <string>

namespace cohort::bridges::ros2 {

/// A type of which DDS knows only the name. Its samples are std::string, containing CDR with the encapsulation header.
class OpaqueType : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit OpaqueType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1024;  // initial size of an allocation
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
    const std::string& sample = *static_cast<std::string*>(data);
    if (sample.size() < 4 || sample.size() > payload->max_size) return false;
    std::memcpy(payload->data, sample.data(), sample.size());
    payload->length = static_cast<std::uint32_t>(sample.size());
    payload->encapsulation = (sample[1] & 1) != 0 ? CDR_LE : CDR_BE;
    return true;
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace cohort::bridges::ros2
