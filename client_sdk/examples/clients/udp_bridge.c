// SPDX-License-Identifier: Apache-2.0

/* The bridge of udp_bridge.cpp in C: firmware with a UDP interface drives one robot of a simulation in lockstep.
 *
 *   udp_bridge ROBOT PORT       the server's domain is $COHORT_DOMAIN, its address $COHORT_SERVER
 *
 * At each tick, the bridge sends one text datagram to 127.0.0.1:PORT, `TICK VALUE VALUE ...`, with the robot's whole
 * observation. It waits for a datagram with the robot's whole command, `TICK VALUE VALUE ...`. It sends a lost
 * datagram again after a second. */

#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <cohort/cohort.h>
#include <inttypes.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

enum { most_channels = 256, largest_datagram = 65536 };

static CohortObservationChannel observed[most_channels];
static size_t observed_count;
static CohortCommandChannel commanded[most_channels];
static size_t commanded_count;
static char text[largest_datagram];

static int connect_to(unsigned short port) {
  const int firmware = socket(AF_INET, SOCK_DGRAM, 0);
  struct sockaddr_in address = {0};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return connect(firmware, (const struct sockaddr*)&address, sizeof address) == 0 ? firmware : -1;
}

/* Looks up all channels of the robot. Returns false if it has more than the bridge supports. */
static bool look_up(const CohortStart* start) {
  observed_count = cohort_find_observations(start, "*/*/*", observed, most_channels);
  commanded_count = cohort_find_commands(start, "*/*/*", commanded, most_channels);
  printf("%s has %zu observation channels and %zu command channels\n", cohort_start_info(start)->name, observed_count,
         commanded_count);
  return observed_count <= most_channels && commanded_count <= most_channels;
}

static void send_observation(int firmware, const CohortObservation* observation) {
  int size = snprintf(text, sizeof text, "%" PRIu64, cohort_tick(observation));
  for (size_t i = 0; i < observed_count; ++i)
    for (uint32_t k = 0; k < observed[i].size && size < largest_datagram; ++k)
      size += snprintf(text + size, sizeof text - (size_t)size, " %.17g", cohort_read_all(observation, observed[i])[k]);
  if (send(firmware, text, (size_t)size, 0) < 0) return; /* lost: sent again later */
}

/* Sets the command from the answer in `text`. Returns false if the answer is not for this tick. */
static bool set_command(uint64_t tick, CohortCommand* command) {
  char* rest = text;
  if (strtoull(rest, &rest, 10) != tick) return false;
  for (size_t i = 0; i < commanded_count; ++i)
    for (uint32_t k = 0; k < commanded[i].size; ++k) {
      char* end = rest;
      const double value = strtod(rest, &end);
      if (end == rest) return false;
      cohort_set_at(command, commanded[i], k, value);
      rest = end;
    }
  return true;
}

/* Returns true if an answer to this tick arrived within a second. */
static bool receive_command(int firmware, uint64_t tick, CohortCommand* command) {
  struct pollfd readable = {firmware, POLLIN, 0};
  while (poll(&readable, 1, 1000) == 1) {
    const ssize_t size = recv(firmware, text, sizeof text - 1, 0);
    if (size < 0) return false; /* the firmware is not running yet */
    text[size] = '\0';
    if (set_command(tick, command)) return true;
  }
  return false;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "Usage: %s ROBOT PORT\n", argv[0]);
    return 2;
  }
  const int firmware = connect_to((unsigned short)atoi(argv[2]));
  const char* const domain = getenv("COHORT_DOMAIN");
  const CohortOptions options = {NULL, domain != NULL ? (uint32_t)strtoul(domain, NULL, 10) : 0, argv[1], "udp_bridge",
                                 NULL};
  CohortClient* const client = firmware >= 0 ? cohort_connect(&options) : NULL;
  if (client == NULL) {
    fprintf(stderr, "udp_bridge: %s\n", firmware >= 0 ? cohort_last_error() : "cannot open the firmware's port");
    return 2;
  }
  CohortEvent event;
  while (cohort_next(client, &event) != cohort_event_end) {
    if (event.kind == cohort_event_start && !look_up(event.start))
      cohort_give_up(client, "the robot has more channels than this bridge supports");
    while (event.kind == cohort_event_observation && !cohort_is_over(client)) {
      send_observation(firmware, event.observation);
      if (receive_command(firmware, cohort_tick(event.observation), event.command)) break;
    }
  }
  const CohortEnd end = event.end;
  cohort_close(client);
  close(firmware);
  return end == cohort_end_finished ? 0 : 1;
}
