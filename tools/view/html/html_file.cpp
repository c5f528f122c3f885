// SPDX-License-Identifier: Apache-2.0
#include "tools/view/html/html_file.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

namespace cohort::view {
namespace {

// A place in index.html.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

[[noreturn]] void refuse(std::string_view missing) {
  throw std::runtime_error("the built page has no '" + std::string(missing) + "' in its index.html");
}

// Finds the element that contains `text` in its first tag, up to and with `end`.
Span element_with(const std::string& html, std::string_view text, std::string_view end) {
  const std::size_t found = html.find(text);
  if (found == std::string::npos) refuse(text);
  const std::size_t begin = html.rfind('<', found);
  const std::size_t last = html.find(end, found);
  if (begin == std::string::npos || last == std::string::npos) refuse(text);
  return {begin, last + end.size()};
}

void replace(std::string& html, Span span, const std::string& text) {
  html.replace(span.begin, span.end - span.begin, text);
}

bool begins_with(std::string_view text, std::string_view lower_case) {
  return text.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), text.begin(), [](char wanted, char given) {
           return wanted == static_cast<char>(std::tolower(static_cast<unsigned char>(given)));
         });
}

std::string sha256_base64(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL cannot compute SHA-256");
  std::array<unsigned char, 2 * EVP_MAX_MD_SIZE> base64{};
  const int length = EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(size));
  return {reinterpret_cast<const char*>(base64.data()), static_cast<std::size_t>(length)};
}

std::string policy_for(std::string_view script) {
  return "default-src 'none'; script-src 'sha256-" + sha256_base64(script) +
         "'; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; base-uri 'none'; form-action 'none'";
}

}  // namespace

std::string escaped_html(std::string_view text) {
  std::string escaped;
  for (const char letter : text) switch (letter) {
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '&': escaped += "&amp;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += letter;
    }
  return escaped;
}

std::string script_for_html(std::string_view script) {
  std::string safe;
  safe.reserve(script.size());
  for (std::size_t i = 0; i < script.size(); ++i)
    if (begins_with(script.substr(i), "</script") || begins_with(script.substr(i), "<!--"))
      safe += "\\x3C";
    else
      safe += script[i];
  return safe;
}

HtmlFile::HtmlFile(const std::filesystem::path& file, const BuiltPage& page, std::string_view title)
    : out_("the page", file) {
  const std::string script = script_for_html(page.script);
  std::string html = page.index;
  // From the end to the beginning, so that nothing is looked for in what was inserted.
  const std::size_t end = html.rfind("</body>");
  if (end == std::string::npos) refuse("</body>");
  tail_ = html.substr(end);
  html.resize(end);
  replace(html, element_with(html, "src=\"page.js\"", "</script>"), "<script type=\"module\">" + script + "</script>");
  replace(html, element_with(html, "href=\"page.css\"", ">"), "<style>" + page.style + "</style>");
  const Span old_title = element_with(html, "title>", "</title>");
  replace(html, old_title, "<title>" + escaped_html(title) + "</title>");
  const Span head = element_with(html, "head>", ">");
  replace(html, head,
          "<head>\n  <meta charset=\"utf-8\">\n  <meta http-equiv=\"Content-Security-Policy\" content=\"" +
              policy_for(script) + "\">");
  write(html);
  page_size_ = size_ + tail_.size();
}

std::size_t HtmlFile::add(std::string_view base64) {
  write("<script type=\"application/x-cohort\">");
  write(base64);
  write("</script>\n");
  return blocks_++;
}

void HtmlFile::commit() {
  write(tail_);
  out_.commit();
}

void HtmlFile::write(std::string_view text) {
  out_.write(text);
  size_ += text.size();
}

}  // namespace cohort::view
