#include "web/page.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "web/base64.hpp"

#define TEGOTAE_EMBED(name, file)     \
  asm(".section .rodata\n"            \
      ".global " #name "\n" #name     \
      ":\n"                           \
      ".incbin \"" file               \
      "\"\n"                          \
      ".global " #name "_end\n" #name \
      "_end:\n"                       \
      ".byte 0\n"                     \
      ".previous\n");                 \
  extern "C" {                        \
  extern const char name[];           \
  extern const char name##_end[];     \
  }

TEGOTAE_EMBED(tegotae_report_html, TEGOTAE_WEB_DIST "/report.html")
TEGOTAE_EMBED(tegotae_review_html, TEGOTAE_WEB_DIST "/review.html")
TEGOTAE_EMBED(tegotae_view_html, TEGOTAE_WEB_DIST "/view.html")

namespace tegotae::apps {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// `page` with the only `marker` replaced by `text`.
std::string replaced(std::string_view page, std::string_view marker, std::string_view text) {
  const std::size_t at = page.find(marker);
  std::string out;
  out.reserve(page.size() + text.size());
  return out.append(page.substr(0, at)).append(text).append(page.substr(at + marker.size()));
}

/// Puts `data` where the page looks for it.
std::string filled(std::string_view page, const nlohmann::json& data) {
  // Names come from files and may not be UTF-8; "</script" in a string would end the element.
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i)) text.replace(i, 1, "\\u003c");
  return replaced(page, "/*DATA*/", text);
}

}  // namespace

std::string report_page(const nlohmann::json& report) {
  return filled(between(tegotae_report_html, tegotae_report_html_end), report);
}

std::string review_page(const std::string& bundle) {
  return replaced(between(tegotae_review_html, tegotae_review_html_end), "/*DATA*/", base64(bundle));
}

std::string view_page(const std::string& nonce) {
  std::string page(between(tegotae_view_html, tegotae_view_html_end));
  constexpr std::string_view marker = "nonce=\"NONCE\"";
  for (std::size_t at = page.find(marker); at != std::string::npos; at = page.find(marker, at))
    page.replace(at, marker.size(), "nonce=\"" + nonce + "\"");
  return replaced(page, "/*DATA*/", "");
}

std::string view_file(const std::string& bundle) {
  return replaced(between(tegotae_view_html, tegotae_view_html_end), "/*DATA*/", base64(bundle));
}

}  // namespace tegotae::apps
