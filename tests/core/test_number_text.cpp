// Numbers in messages are written as people write them.
#include "core/number_text.hpp"

#include <limits>
#include <random>

#include "catch.hpp"

using namespace tegotae;

TEST_CASE("numbers have no exponent and no sign of zero", "[number_text]") {
  CHECK(number_text(2666.7, 3) == "2667");
  CHECK(number_text(9999.96, 4) == "10000");
  CHECK(number_text(20000, 3) == "20000");
  CHECK(number_text(12.345, 3) == "12.3");
  CHECK(number_text(0.3, 4) == "0.3");
  CHECK(number_text(0.000123456, 3) == "0.000123");
  CHECK(number_text(0.0000123456, 3) == "0.000012");
  CHECK(number_text(6.484e-10, 4) == "0");
  CHECK(number_text(-6.484e-10, 4) == "0");
  CHECK(number_text(-0.0, 3) == "0");
  CHECK(number_text(-5000, 3) == "-5000");
  CHECK(number_text(1e300, 6) == "10^300");
  CHECK(number_text(2.5e20, 2) == "2.5 x 10^20");
  CHECK(number_text(std::numeric_limits<double>::infinity(), 3) == "inf");
  CHECK(fixed_text(-0.04, 1) == "0.0");
  CHECK(fixed_text(-0.06, 1) == "-0.1");
  CHECK(fixed_text(0, 2) == "0.00");
  CHECK(fixed_text(-1e-9, 0) == "0");
  CHECK(fixed_text(12.345, 1) == "12.3");
}

TEST_CASE("numbers of any size read back as what they were, to their digits", "[number_text]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> mantissa(-9.9, 9.9), size(-4, 20);
  for (int i = 0; i < 10000; ++i) {
    const double x = mantissa(random) * std::pow(10.0, size(random));
    const std::string text = number_text(x, 4);
    INFO(x << " as " << text);
    CHECK(text.find('e') == std::string::npos);
    const std::size_t power = text.find(" x 10^");
    double back = std::stod(text);
    if (power != std::string::npos) back *= std::pow(10.0, std::stod(text.substr(power + 6)));
    CHECK(std::abs(back - x) <= 6e-4 * std::abs(x) + 5e-7);
  }
}
