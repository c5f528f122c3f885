// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/math/library_calls.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "client_sdk/math/portable_math.hpp"

extern "C" const char cohort_portable_math;  // in portable_math.cpp

namespace cohort {
namespace {

struct Function {
  const char* name;
  std::uintptr_t ours;
};

// Selects the overload for double, or for float, of functions with one name.
Function unary(const char* name, double (*function)(double)) {
  return {name, reinterpret_cast<std::uintptr_t>(function)};
}
Function unary_of_float(const char* name, float (*function)(float)) {
  return {name, reinterpret_cast<std::uintptr_t>(function)};
}
Function binary(const char* name, double (*function)(double, double)) {
  return {name, reinterpret_cast<std::uintptr_t>(function)};
}
Function binary_of_float(const char* name, float (*function)(float, float)) {
  return {name, reinterpret_cast<std::uintptr_t>(function)};
}

const auto& our_functions() {
  static const std::array functions = {
      unary("sin", ::sin),
      unary("cos", ::cos),
      Function{"sincos", reinterpret_cast<std::uintptr_t>(&::sincos)},
      unary("tan", ::tan),
      unary("atan", ::atan),
      binary("atan2", ::atan2),
      unary("asin", ::asin),
      unary("acos", ::acos),
      unary("exp", ::exp),
      unary("log", ::log),
      unary("log2", ::log2),
      unary("log10", ::log10),
      unary("exp2", ::exp2),
      binary("pow", ::pow),
      unary_of_float("sinf", ::sinf),
      unary_of_float("cosf", ::cosf),
      Function{"sincosf", reinterpret_cast<std::uintptr_t>(&::sincosf)},
      unary_of_float("tanf", ::tanf),
      unary_of_float("atanf", ::atanf),
      binary_of_float("atan2f", ::atan2f),
      unary_of_float("asinf", ::asinf),
      unary_of_float("acosf", ::acosf),
      unary_of_float("expf", ::expf),
      unary_of_float("logf", ::logf),
      unary_of_float("log2f", ::log2f),
      unary_of_float("log10f", ::log10f),
      unary_of_float("exp2f", ::exp2f),
      binary_of_float("powf", ::powf),
  };
  return functions;
}

// A loaded object, as described by its dynamic section (System V ABI, "Dynamic Linking").
struct Object {
  std::uintptr_t base = 0;
  std::uintptr_t begin = 0, end = 0;              // range of the loaded segments
  std::uintptr_t relro_begin = 0, relro_end = 0;  // read-only after relocation
  std::string_view soname{};
  std::vector<std::string_view> needed{};
  std::span<const ElfW(Rela)> calls{};  // through the procedure linkage table
  std::span<const ElfW(Rela)> data{};
  const ElfW(Sym) * symbols = nullptr;
  const char* strings = nullptr;
};

void read_dynamic_section(Object& object, const ElfW(Dyn) * dynamic) {
  // Most of these are absolute addresses by now; the C library leaves some as offsets.
  const auto address = [&](const ElfW(Dyn) & entry) {
    return entry.d_un.d_ptr < object.base ? entry.d_un.d_ptr + object.base : entry.d_un.d_ptr;
  };
  std::uintptr_t calls = 0, data = 0;
  std::size_t calls_size = 0, data_size = 0;
  std::vector<std::size_t> needed;
  std::size_t soname = 0;
  for (const ElfW(Dyn)* entry = dynamic; entry->d_tag != DT_NULL; ++entry) {
    switch (entry->d_tag) {
      case DT_STRTAB: object.strings = reinterpret_cast<const char*>(address(*entry)); break;
      case DT_SYMTAB: object.symbols = reinterpret_cast<const ElfW(Sym)*>(address(*entry)); break;
      case DT_JMPREL: calls = address(*entry); break;
      case DT_PLTRELSZ: calls_size = entry->d_un.d_val; break;
      case DT_RELA: data = address(*entry); break;
      case DT_RELASZ: data_size = entry->d_un.d_val; break;
      case DT_NEEDED: needed.push_back(entry->d_un.d_val); break;
      case DT_SONAME: soname = entry->d_un.d_val; break;
      default: break;
    }
  }
  if (object.strings == nullptr) return;
  if (soname != 0) object.soname = object.strings + soname;
  for (const std::size_t name : needed) object.needed.emplace_back(object.strings + name);
  const auto entries = [](std::uintptr_t at, std::size_t size) {
    return std::span(reinterpret_cast<const ElfW(Rela)*>(at), at == 0 ? 0 : size / sizeof(ElfW(Rela)));
  };
  object.calls = entries(calls, calls_size);
  object.data = entries(data, data_size);
}

int add_object(dl_phdr_info* info, std::size_t, void* objects) {
  Object object{.base = info->dlpi_addr};
  const ElfW(Dyn)* dynamic = nullptr;
  for (const ElfW(Phdr) & header : std::span(info->dlpi_phdr, info->dlpi_phnum)) {
    const std::uintptr_t begin = object.base + header.p_vaddr, end = begin + header.p_memsz;
    if (header.p_type == PT_DYNAMIC) dynamic = reinterpret_cast<const ElfW(Dyn)*>(begin);
    if (header.p_type == PT_GNU_RELRO) object.relro_begin = begin, object.relro_end = end;
    if (header.p_type != PT_LOAD) continue;
    object.begin = object.end == 0 ? begin : std::min(object.begin, begin);
    object.end = std::max(object.end, end);
  }
  if (dynamic != nullptr) read_dynamic_section(object, dynamic);
  static_cast<std::vector<Object>*>(objects)->push_back(object);
  return 0;
}

std::vector<Object> loaded_objects() {
  std::vector<Object> objects;
  dl_iterate_phdr(add_object, &objects);
  return objects;
}

// Returns the libraries that the object with this code needs, directly or indirectly.
std::vector<Object> libraries_needed() {
  const std::vector<Object> loaded = loaded_objects();
  const auto here = reinterpret_cast<std::uintptr_t>(&libraries_needed);
  std::vector<Object> needed;
  std::vector<const Object*> to_visit;
  for (const Object& object : loaded)
    if (object.begin <= here && here < object.end) to_visit.push_back(&object);
  while (!to_visit.empty()) {
    const Object& from = *to_visit.back();
    to_visit.pop_back();
    for (const std::string_view name : from.needed) {
      const auto is_it = [&](const Object& object) { return object.soname == name; };
      const auto library = std::ranges::find_if(loaded, is_it);
      if (library == loaded.end() || std::ranges::any_of(needed, is_it)) continue;
      needed.push_back(*library);
      to_visit.push_back(&*library);
    }
  }
  return needed;
}

bool is_bound_by_name(const ElfW(Rela) & relocation) {
  const auto type = static_cast<std::uint32_t>(ELF64_R_TYPE(relocation.r_info));
#if defined(__x86_64__)
  return type == R_X86_64_JUMP_SLOT || type == R_X86_64_GLOB_DAT || type == R_X86_64_64;
#elif defined(__aarch64__)
  return type == R_AARCH64_JUMP_SLOT || type == R_AARCH64_GLOB_DAT || type == R_AARCH64_ABS64;
#else
#error "which relocations bind a name to an address on this machine?"
#endif
}

// Calls `visit(object, function, slot)` for each place that holds the address of one of these functions.
template <class Visit>
void visit_slots(const std::vector<Object>& objects, Visit&& visit) {
  for (const Object& object : objects) {
    for (const auto& relocations : {object.calls, object.data}) {
      for (const ElfW(Rela) & relocation : relocations) {
        const ElfW(Sym)& symbol = object.symbols[ELF64_R_SYM(relocation.r_info)];
        if (symbol.st_shndx != SHN_UNDEF || !is_bound_by_name(relocation)) continue;
        const std::string_view name = object.strings + symbol.st_name;
        for (const Function& function : our_functions())
          if (name == function.name) visit(object, function, object.base + relocation.r_offset);
      }
    }
  }
}

std::uintptr_t& value_at(std::uintptr_t slot) { return *reinterpret_cast<std::uintptr_t*>(slot); }

// Other threads may call through the slot meanwhile.
void write_slot(const Object& object, std::uintptr_t slot, std::uintptr_t value) {
  const std::atomic_ref<std::uintptr_t> target(value_at(slot));
  if (slot < object.relro_begin || slot >= object.relro_end) return target.store(value);
  const auto page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  auto* page = reinterpret_cast<void*>(slot / page_size * page_size);
  if (mprotect(page, page_size, PROT_READ | PROT_WRITE) != 0)
    throw std::runtime_error("cannot bind the calls of " + std::string(object.soname) +
                             " to portable functions: mprotect failed");
  target.store(value);
  mprotect(page, page_size, PROT_READ);
}

// A slot that was changed, and the address that it had.
struct ChangedSlot {
  std::uintptr_t slot = 0;
  std::uintptr_t before = 0;
  std::uintptr_t ours = 0;
};

void bind(const std::vector<Object>& objects, std::vector<ChangedSlot>& changed) {
  visit_slots(objects, [&](const Object& object, const Function& function, std::uintptr_t slot) {
    const std::uintptr_t before = value_at(slot);
    if (before == function.ours) return;
    write_slot(object, slot, function.ours);
    changed.push_back({slot, before, function.ours});
  });
}

// A library may have been unloaded since.
void restore(std::vector<ChangedSlot>& changed) {
  visit_slots(loaded_objects(), [&](const Object& object, const Function& function, std::uintptr_t slot) {
    const auto found = std::ranges::find(changed, slot, &ChangedSlot::slot);
    if (found != changed.end() && found->ours == function.ours && value_at(slot) == function.ours)
      write_slot(object, slot, found->before);
  });
  changed.clear();
}

// The calls of the whole process, while they are bound.
struct ProcessCalls {
  std::mutex mutex;
  int count = 0;
  std::vector<ChangedSlot> changed;
};
ProcessCalls& process_calls() {
  static ProcessCalls calls;
  return calls;
}

// Returns true if the program has its own functions of portable_math.cpp. It exports them, so everything loaded is
// already bound to them.
bool is_bound_by_program() {
  const void* const exported = dlsym(RTLD_DEFAULT, "cohort_portable_math");
  return exported != nullptr && exported != &cohort_portable_math;
}

}  // namespace

void bind_library_calls() {
  if (is_bound_by_program()) return;
  std::vector<ChangedSlot> for_ever;
  bind(libraries_needed(), for_ever);
}

void bind_process_calls() {
  if (is_bound_by_program()) return;
  ProcessCalls& calls = process_calls();
  const std::lock_guard lock(calls.mutex);
  try {
    if (calls.count == 0) bind(loaded_objects(), calls.changed);
  } catch (...) {
    restore(calls.changed);
    throw;
  }
  ++calls.count;
}

void release_process_calls() {
  ProcessCalls& calls = process_calls();
  const std::lock_guard lock(calls.mutex);
  if (calls.count > 0 && --calls.count == 0) restore(calls.changed);
}

std::vector<std::string> functions_not_portable() {
  std::vector<std::string> missing;
  if (is_bound_by_program()) return missing;
  // The dynamic linker binds calls to the first definition that it finds.
  for (const Function& function : our_functions())
    if (reinterpret_cast<std::uintptr_t>(dlsym(RTLD_DEFAULT, function.name)) != function.ours)
      missing.emplace_back(function.name);
  if (missing.empty()) return missing;
  missing.clear();
  visit_slots(libraries_needed(), [&](const Object&, const Function& function, std::uintptr_t slot) {
    if (value_at(slot) != function.ours && std::ranges::find(missing, function.name) == missing.end())
      missing.emplace_back(function.name);
  });
  return missing;
}

}  // namespace cohort
