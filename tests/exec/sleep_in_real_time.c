// SPDX-License-Identifier: Apache-2.0

/* A thread sleeps in real time, and the first one in virtual time. With the argument "kernel" the thread sleeps for two
 * seconds, by the C library's own syscall. With "dds" and "often in dds" it sleeps in a library that is named as one of
 * DDS: for 0.3 s, or for 20 ms again and again. The first one waits until it has woken; with "often in dds" for 1 s. */

#define _GNU_SOURCE  // NOLINT(readability-identifier-naming): for RTLD_NOLOAD
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>

extern void sleep_of_dds(struct timespec time);

static const struct timespec two_seconds = {2, 0};
static const struct timespec moment = {0, 10000000};
static const struct timespec a_while = {0, 300000000};
static const struct timespec nap = {0, 20000000};
static atomic_int is_done;
static atomic_int is_over;

static void* sleep_by_kernel(void* unused) {
  long (*const call)(long, ...) = (long (*)(long, ...))dlsym(dlopen("libc.so.6", RTLD_LAZY | RTLD_NOLOAD), "syscall");
  call(SYS_nanosleep, &two_seconds, NULL);
  is_done = 1;
  return unused;
}

static void* sleep_in_dds(void* unused) {
  sleep_of_dds(a_while);
  is_done = 1;
  return unused;
}

static void* sleep_often_in_dds(void* unused) {
  while (!is_over) sleep_of_dds(nap);
  return unused;
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const int is_often = strcmp(arguments[1], "often in dds") == 0;
  const int is_in_dds = strcmp(arguments[1], "dds") == 0;
  pthread_t thread = 0;
  pthread_create(&thread, NULL, is_often ? &sleep_often_in_dds : is_in_dds ? &sleep_in_dds : &sleep_by_kernel, NULL);
  for (int i = 0; is_often ? i < 100 : !is_done; ++i) nanosleep(&moment, NULL);
  is_over = 1;
  return pthread_join(thread, NULL);
}
