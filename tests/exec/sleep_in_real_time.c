/* A thread sleeps in real time for two seconds, and the first one in virtual time until it has woken. With the argument
 * "kernel" it calls the C library's own syscall; with "dds" it sleeps within a library that is named as one of DDS. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>

extern void sleep_of_dds(struct timespec time);

static const struct timespec two_seconds = {2, 0};
static const struct timespec moment = {0, 10000000};
static atomic_int is_done;

static void* sleep_by_kernel(void* unused) {
  long (*const call)(long, ...) = (long (*)(long, ...))dlsym(dlopen("libc.so.6", RTLD_LAZY | RTLD_NOLOAD), "syscall");
  call(SYS_nanosleep, &two_seconds, NULL);
  is_done = 1;
  return unused;
}

static void* sleep_in_dds(void* unused) {
  sleep_of_dds(two_seconds);
  is_done = 1;
  return unused;
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  pthread_t thread;
  pthread_create(&thread, NULL, strcmp(arguments[1], "dds") == 0 ? &sleep_in_dds : &sleep_by_kernel, NULL);
  while (!is_done) nanosleep(&moment, NULL);
  return pthread_join(thread, NULL);
}
