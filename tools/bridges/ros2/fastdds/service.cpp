// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/fastdds/service.hpp"

#include <fastdds/rtps/common/WriteParams.h>

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <stdexcept>
#include <utility>

#include "tools/bridges/ros2/fastdds/guids.hpp"

namespace cohort::bridges::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using namespace std::chrono_literals;

constexpr auto longest_wait = 5s;
constexpr std::size_t most_waiting = 1000;

}  // namespace

Service::Service(Domain& domain, Output& output, const OfferService& offered)
    : domain_(domain), output_(output), number_(offered.service) {
  dds::Topic* requests = domain.make_topic(offered.request_topic, offered.request_type);
  dds::Topic* replies = domain.make_topic(offered.reply_topic, offered.reply_type);

  // Services keep the last 10. More on our side loses nothing when many clients ask at once.
  dds::DataWriterQos writer_qos = domain.publisher().get_default_datawriter_qos();
  writer_qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  writer_qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  writer_qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  writer_qos.history().depth = 1000;
  writer_qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;  // which larger samples need
  writer_qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  writer_qos.data_sharing().off();
  writer_qos.user_data().assign(offered.reply_user_data.begin(), offered.reply_user_data.end());
  writer_ = domain.publisher().create_datawriter(replies, writer_qos, this, dds::StatusMask::publication_matched());
  if (writer_ == nullptr) throw std::runtime_error("cannot create a writer for '" + offered.reply_topic + "'");

  dds::DataReaderQos reader_qos = domain.subscriber().get_default_datareader_qos();
  reader_qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  reader_qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  reader_qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  reader_qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  reader_qos.data_sharing().off();
  reader_qos.user_data().assign(offered.request_user_data.begin(), offered.request_user_data.end());
  reader_ = domain.subscriber().create_datareader(requests, reader_qos, this, dds::StatusMask::data_available());
  if (reader_ == nullptr) throw std::runtime_error("cannot create a reader for '" + offered.request_topic + "'");
  if (!offered.is_shared) return;
  // This one only counts.
  reader_qos.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
  reader_qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  reader_qos.history().depth = 1;
  counted_reader_ = domain.subscriber().create_datareader(requests, reader_qos);
  if (counted_reader_ == nullptr)
    throw std::runtime_error("cannot create a second reader for '" + offered.request_topic + "'");
}

Service::~Service() {
  if (counted_reader_ != nullptr) domain_.subscriber().delete_datareader(counted_reader_);
  if (reader_ != nullptr) domain_.subscriber().delete_datareader(reader_);
  if (writer_ != nullptr) domain_.publisher().delete_datawriter(writer_);
}

Guid Service::request_reader() const { return to_guid(reader_->guid()); }
Guid Service::reply_writer() const { return to_guid(writer_->guid()); }

void Service::on_data_available(dds::DataReader* reader) {
  RequestReceived request;
  dds::SampleInfo info;
  while (reader->take_next_sample(&request.request, &info) == ReturnCode_t::RETCODE_OK) {
    const Guid writer = to_guid(info.sample_identity.writer_guid());
    if (!info.valid_data || domain_.is_of_cyclone(writer)) continue;
    const rtps::GUID_t& client = info.related_sample_identity.writer_guid();
    request.service = number_;
    request.client = client == rtps::GUID_t::unknown() ? writer : to_guid(client);
    request.sequence = static_cast<std::int64_t>(info.sample_identity.sequence_number().to64long());
    output_.send_request(request);
  }
}

void Service::on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& info) {
  const Guid reader = to_guid(rtps::iHandle2GUID(info.last_subscription_handle));
  const std::lock_guard lock(mutex_);
  if (info.current_count_change > 0)
    clients_.insert(reader);
  else
    clients_.erase(reader);
  send_waiting();
}

// A client that did not say which its reader is has been given its writer's identity: any reader of its participant.
bool Service::is_there(const Guid& client) const {
  if (clients_.contains(client)) return true;
  const rtps::EntityId_t entity = from_guid(client).entityId;
  if (entity.value[3] == 0x04 || entity.value[3] == 0x07) return false;  // a reader, which is not there yet
  Guid first = client;
  std::fill(first.begin() + 12, first.end(), std::uint8_t{0});
  const auto found = clients_.lower_bound(first);
  return found != clients_.end() && std::equal(first.begin(), first.begin() + 12, found->begin());
}

void Service::reply(SendReply reply) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back({std::move(reply), Clock::now() + longest_wait});
  send_waiting();
  if (waiting_.size() > most_waiting) waiting_.pop_front();
}

void Service::send_waiting() {
  std::erase_if(waiting_, [this](Waiting& each) {
    if (!is_there(each.reply.client)) return false;
    write(each.reply);
    return true;
  });
}

void Service::drop_old_replies() {
  const std::lock_guard lock(mutex_);
  while (!waiting_.empty() && waiting_.front().until < Clock::now()) waiting_.pop_front();
}

void Service::write(SendReply& reply) {
  rtps::WriteParams parameters;
  parameters.related_sample_identity().writer_guid(from_guid(reply.client));
  parameters.related_sample_identity().sequence_number(
      rtps::SequenceNumber_t(static_cast<std::uint64_t>(reply.sequence)));
  writer_->write(&reply.reply, parameters);
}

}  // namespace cohort::bridges::ros2
