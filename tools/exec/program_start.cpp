// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/program_start.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "tools/exec/preload_library.hpp"

namespace cohort::exec {
namespace {

std::string system_text(const std::string& what) { return what + ": " + std::generic_category().message(errno); }

}  // namespace

PageFile::PageFile() {
  std::string name = "/dev/shm/cohort-exec-XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) throw std::runtime_error(system_text("cannot create a file in /dev/shm"));
  path_ = name;
  if (::ftruncate(file, sizeof(ClockPage)) == 0)
    memory_ = ::mmap(nullptr, sizeof(ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory_ == nullptr || memory_ == MAP_FAILED) {
    ::unlink(path_.c_str());
    throw std::runtime_error(system_text("cannot map a file in /dev/shm"));
  }
  ::new (memory_) ClockPage;
}

PageFile::~PageFile() {
  ::munmap(memory_, sizeof(ClockPage));
  ::unlink(path_.c_str());
}

pid_t start_program(ProgramOptions& options, const std::filesystem::path& program, const std::string& page_file) {
  const std::filesystem::path library = preload_library();
  std::vector<std::string> environment;
  std::string preload = library.string();
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string variable = *each;
    if (variable.starts_with("LD_PRELOAD="))
      preload += ":" + variable.substr(variable.find('=') + 1);
    else
      environment.push_back(variable);
  }
  if (std::getenv("PYTHONHASHSEED") == nullptr) environment.emplace_back("PYTHONHASHSEED=0");
  environment.insert(environment.end(), options.environment.begin(), options.environment.end());
  environment.push_back("LD_PRELOAD=" + preload);
  environment.push_back(std::string(page_variable) + "=" + page_file);
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> all;
    all.reserve(texts.size() + 1);
    for (std::string& text : texts) all.push_back(text.data());
    all.push_back(nullptr);
    return all;
  };
  const std::vector<char*> arguments = pointers(options.command);
  const std::vector<char*> variables = pointers(environment);
  int problem[2];
  if (::pipe2(problem, O_CLOEXEC) != 0) throw std::runtime_error(system_text("cannot create a pipe"));
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {
    const char* what = "cannot start it";
    const auto fail = [&] {
      const int error = errno;
      (void)(::write(problem[1], &error, sizeof error) + ::write(problem[1], what, std::strlen(what)));
      ::_exit(127);
    };
    if (options.prepare && !options.prepare()) {
      what = "cannot prepare its process";
      fail();
    }
    // So that addresses are the same in each run, as far as the machine allows it.
    if (const int kind = ::personality(0xffffffff); kind != -1)
      (void)::personality(static_cast<unsigned>(kind) | ADDR_NO_RANDOMIZE);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) {
      what = "cannot change to its folder";
      fail();
    }
    ::execve(program.c_str(), arguments.data(), variables.data());
    fail();
  }
  ::close(problem[1]);
  int error = 0;
  if (process > 0 && ::read(problem[0], &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
    std::string what(100, '\0');
    what.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(problem[0], what.data(), what.size()), 0)));
    ::close(problem[0]);
    ::waitpid(process, nullptr, 0);
    throw std::runtime_error("'" + options.name + "': " + what + ": " + std::generic_category().message(error));
  }
  ::close(problem[0]);
  if (process < 0) throw std::runtime_error(system_text("cannot start a process"));
  return process;
}

}  // namespace cohort::exec
