#include "web/page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

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

namespace tegotae::apps {
namespace {

/// Puts `data` where the page looks for it.
std::string filled(std::string_view page, const nlohmann::json& data) {
  constexpr std::string_view marker = "/*DATA*/";
  const std::size_t at = page.find(marker);
  // Names come from files and may not be UTF-8; "</script" in a string would end the element.
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i)) text.replace(i, 1, "\\u003c");
  std::string out(page.substr(0, at));
  out += text;
  return out += page.substr(at + marker.size());
}

}  // namespace

std::string report_page(const nlohmann::json& report) {
  return filled({tegotae_report_html, static_cast<std::size_t>(tegotae_report_html_end - tegotae_report_html)}, report);
}

}  // namespace tegotae::apps
