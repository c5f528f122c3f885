// SPDX-License-Identifier: Apache-2.0

/* A program on Cyclone DDS that waits for data, by the clock of DDS. */

#include <dds/dds.h>
#include <pthread.h>
#include <stdio.h>

static dds_entity_t guard;

static void* trigger(void* unused) {
  (void)unused;
  dds_sleepfor(DDS_MSECS(30));
  dds_set_guardcondition(guard, true);
  return NULL;
}

int main(void) {
  const dds_entity_t participant = dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL);
  if (participant < 0) return 1;
  const dds_entity_t set = dds_create_waitset(participant);
  guard = dds_create_guardcondition(participant);
  dds_waitset_attach(set, guard, 5);
  dds_attach_t found[1];

  dds_time_t begin = dds_time();
  int count = dds_waitset_wait(set, found, 1, DDS_MSECS(250));
  printf("nothing within %d ms: %d\n", (int)((dds_time() - begin) / 1000000), count);

  begin = dds_time();
  count = dds_waitset_wait_until(set, found, 1, begin + DDS_MSECS(100));
  printf("nothing until then, after %d ms: %d\n", (int)((dds_time() - begin) / 1000000), count);

  pthread_t thread;
  pthread_create(&thread, NULL, &trigger, NULL);
  begin = dds_time();
  count = dds_waitset_wait(set, found, 1, DDS_SECS(10));
  printf("triggered after %d ms: %d\n", (int)((dds_time() - begin) / 1000000), count);
  pthread_join(thread, NULL);

  begin = dds_time();
  dds_sleepfor(DDS_MSECS(40));
  printf("slept %d ms\n", (int)((dds_time() - begin) / 1000000));
  dds_delete(participant);
  return 0;
}
