// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "server/core/atomic_file.hpp"

namespace cohort::view {

/// The files of the built page.
struct BuiltPage {
  std::string index;   ///< index.html
  std::string script;  ///< page.js
  std::string style;   ///< page.css
};

/// An HTML file that contains the page with its script and its style, and blocks of data. Its content security policy
/// forbids all requests, and all scripts except that of the page, which is allowed by its hash.
class HtmlFile {
 public:
  /// Writes the page. Throws std::runtime_error if `page` is not the built page, and WriteError.
  HtmlFile(const std::filesystem::path& file, const BuiltPage& page, std::string_view title);

  /// Appends a block of data, in base64. Returns its index among the blocks.
  std::size_t add(std::string_view base64);
  /// Completes the file and gives it its name. Without this call, the file is discarded.
  void commit();

  /// Returns the number of bytes that are written.
  std::size_t size() const { return size_; }
  /// Returns the number of bytes that the page takes, without data.
  std::size_t page_size() const { return page_size_; }

 private:
  void write(std::string_view text);

  AtomicFile out_;
  std::string tail_;
  std::size_t size_ = 0;
  std::size_t page_size_ = 0;
  std::size_t blocks_ = 0;
};

/// Escapes text for use as the content of an HTML element.
std::string escaped_html(std::string_view text);
/// Returns a script that no HTML parser ends too early: `</script` and `<!--`, which may only occur in its strings, are
/// escaped.
std::string script_for_html(std::string_view script);

}  // namespace cohort::view
