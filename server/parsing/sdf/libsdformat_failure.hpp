#pragma once

#include <new>
#include <optional>
#include <sdf/Exception.hh>
#include <stdexcept>
#include <string>

namespace cohort::parsing {

/// Calls what uses libsdformat, and returns why it ended, or nothing if it did what it should. What libsdformat throws
/// where an assertion fails is no std::exception. Want of memory is nothing that a file is to blame for: it is thrown.
template <class Call>
std::optional<std::string> libsdformat_failure(Call&& call) {
  try {
    call();
    return std::nullopt;
  } catch (const sdf::Exception& error) {
    return error.GetErrorStr();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace cohort::parsing
