// The pages that programs write: whole, self-contained, and no name in the data can break out of it.
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "web/page.hpp"

using namespace tegotae::apps;

namespace {

/// The JSON that a browser would find in the page.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">", end = "</script>";
  const std::size_t from = page.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t to = page.find(end, from);
  REQUIRE(to != std::string::npos);
  return nlohmann::json::parse(page.substr(from + begin.size(), to - from - begin.size()));
}

}  // namespace

TEST_CASE("a report's data come back out of its page", "[page]") {
  const nlohmann::json report = {{"title", "</script><script>alert(1)</script> & <!-- \\u003c"},
                                 {"sections", {{{"title", "$& $1 /*DATA*/"}, {"text", "μm"}}}}};
  CHECK(data_of(report_page(report)) == report);
}

TEST_CASE("a name that is not UTF-8 does not lose the report", "[page]") {
  const nlohmann::json found = data_of(report_page({{"title",
                                                     "a\xff"
                                                     "b"}}));
  CHECK(found["title"] ==
        "a\xEF\xBF\xBD"
        "b");
}

TEST_CASE("pages ask for nothing from elsewhere", "[page]") {
  const std::string page = report_page({{"title", "t"}});
  CHECK(page.find("</html>") != std::string::npos);
  for (const char* outside : {" src=\"", "@import", "url(http", "fetch(", "<link"})
    CHECK(page.find(outside) == std::string::npos);
}
