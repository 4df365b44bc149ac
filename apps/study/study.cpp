#include "study/study.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <random>

namespace tegotae::study {
namespace {

constexpr double kDeviations = 3;  // from the middle of a tolerance to its bounds

double drawn(const Axis& axis, std::uint64_t seed, int number, std::size_t which) {
  std::seed_seq seeds{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(which + 1)};
  std::mt19937_64 rng(seeds);
  const double middle = 0.5 * (axis.low + axis.high), half = 0.5 * (axis.high - axis.low);
  if (axis.draw == Axis::Draw::uniform) return middle + half * std::uniform_real_distribution<double>(-1, 1)(rng);
  std::normal_distribution<double> normal;
  double share = normal(rng) / kDeviations;
  while (share < -1 || share > 1) share = normal(rng) / kDeviations;
  return middle + half * share;
}

}  // namespace

std::string digits(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::size_t Axis::size() const {
  return std::max<std::size_t>(1, std::max(texts.size(), numbers.size()));
}

std::string Axis::column() const {
  if (name == "operator" || name == "offset" || name == "tilt") return "";
  return name.rfind("inward ", 0) == 0 ? name + "_m" : name;
}

const Value* Case::find(const std::string& axis) const {
  const auto found = values.find(axis);
  return found == values.end() ? nullptr : &found->second;
}

int case_count(const Study& study) {
  std::size_t n = 1;
  for (const Axis& axis : study.axes) n *= axis.size();
  return static_cast<int>(n) * study.repeats;
}

Case make_case(const Study& study, int number) {
  Case c;
  c.number = number;
  std::size_t rest = static_cast<std::size_t>(number);
  for (std::size_t i = 0; i < study.axes.size(); ++i) {
    const Axis& axis = study.axes[i];
    Value v;
    v.index = rest % axis.size();
    rest /= axis.size();
    if (!axis.texts.empty()) {
      v.text = axis.texts[v.index];
    } else {
      v.number = axis.draw == Axis::Draw::none ? axis.numbers[v.index] : drawn(axis, study.seed, number, i);
      v.text = digits(v.number);
    }
    c.values[axis.name] = v;
  }
  c.repeat = static_cast<int>(rest);
  return c;
}

std::vector<std::string> parameter_columns(const Study& study) {
  std::vector<std::string> out;
  for (const Axis& axis : study.axes)
    if (!axis.column().empty()) out.push_back(axis.column());
  return out;
}

std::vector<std::string> parameter_cells(const Study& study, const Case& c) {
  std::vector<std::string> out;
  for (const Axis& axis : study.axes)
    if (!axis.column().empty()) out.push_back(c.values.at(axis.name).text);
  return out;
}

std::string axes_text(const Study& study) {
  std::string text = "goal " + study.goal + "\nseconds " + digits(study.seconds) + "\n";
  for (const Axis& axis : study.axes) {
    text += axis.name;
    for (const std::string& t : axis.texts) text += "\n  " + t;
    for (const double x : axis.numbers) text += "\n  " + digits(x);
    if (axis.draw != Axis::Draw::none)
      text += (axis.draw == Axis::Draw::uniform ? "\n  uniform " : "\n  tolerance ") + digits(axis.low) + " " +
              digits(axis.high);
    text += "\n";
  }
  for (const std::vector<std::string>& order : study.orders) {
    text += "order";
    for (const std::string& part : order) text += "\n  " + part;
    text += "\n";
  }
  return text;
}

}  // namespace tegotae::study
