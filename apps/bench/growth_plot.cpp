#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/results.hpp"

namespace tegotae::bench {
namespace {

// Both axes are logarithmic: decades of triangles across, of µs upwards.
constexpr double kLeft = 70, kTop = 20, kDecadeWidth = 150, kDecadeHeight = 70;
constexpr int kFirstX = 3, kLastX = 6, kFirstY = 1, kLastY = 5;
constexpr double kRight = kLeft + (kLastX - kFirstX) * kDecadeWidth,
                 kBottom = kTop + (kLastY - kFirstY) * kDecadeHeight;

std::string text(double x, double y, const char* anchor, const std::string& what) {
  char line[256];
  std::snprintf(line, sizeof line, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor,
                what.c_str());
  return line;
}

double x_of(double triangles) {
  return kLeft + (std::log10(triangles) - kFirstX) * kDecadeWidth;
}
double y_of(double us) {
  return std::clamp(kBottom - (std::log10(us) - kFirstY) * kDecadeHeight, kTop, kBottom);
}

using Points = std::vector<std::pair<double, double>>;

std::string curve(const Points& points, const char* color, const std::string& name) {
  std::string path, marks;
  char one[128];
  for (const auto& [triangles, us] : points) {
    std::snprintf(one, sizeof one, "%s%.1f %.1f", path.empty() ? "M" : " L", x_of(triangles), y_of(us));
    path += one;
    std::snprintf(one, sizeof one, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", x_of(triangles), y_of(us),
                  color);
    marks += one;
  }
  if (points.empty()) return "";
  return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + color + "\" stroke-width=\"2\"/>\n" + marks +
         text(x_of(points.back().first) + 8, y_of(points.back().second) - 8, "start", name);
}

}  // namespace

std::string growth_plot(const Results& results) {
  Points tick, tail, fcl;
  for (const SceneFigures& s : results.rows) {
    // The three scenes of one fit with equal counts on both sides.
    if (s.scene.find("@0.99") == std::string::npos || s.scene.size() != s.scene.find("@0.99") + 5) continue;
    if (s.fixed_triangles > 2 * s.held_triangles || s.hand.in_contact == 0) continue;
    const double n = static_cast<double>(s.held_triangles);
    tick.emplace_back(n, s.hand.tick_us.p50);
    tail.emplace_back(n, s.hand.tick_us.p999);
    fcl.emplace_back(n, s.fcl.us.p50);
  }
  char head[256];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" "
                "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                kRight + 60, kBottom + 60);
  std::string svg = head;
  char line[256];
  for (int d = kFirstX; d <= kLastX; ++d) {
    const double x = x_of(std::pow(10, d));
    std::snprintf(line, sizeof line, "<path d=\"M%.1f %.1f V%.1f\" stroke=\"#ddd\"/>\n", x, kTop, kBottom);
    svg += line +
           text(x, kBottom + 18, "middle", d == 6 ? "1 M" : std::to_string(std::lround(std::pow(10, d - 3))) + " k");
  }
  for (int d = kFirstY; d <= kLastY; ++d) {
    const double y = y_of(std::pow(10, d));
    std::snprintf(line, sizeof line, "<path d=\"M%.1f %.1f H%.1f\" stroke=\"#ddd\"/>\n", kLeft, y, kRight);
    svg += line + text(kLeft - 8, y + 4, "end",
                       d < 3 ? std::to_string(std::lround(std::pow(10, d))) + " µs"
                             : std::to_string(std::lround(std::pow(10, d - 3))) + " ms");
  }
  svg += text((kLeft + kRight) / 2, kBottom + 42, "middle", "triangles of the peg, and as many of its hole (0.99)");
  svg += curve(tick, "#0a6", "tick, median") + curve(tail, "#0a6", "tick, p99.9") + curve(fcl, "#c40", "FCL, median");
  return svg + "</svg>\n";
}

}  // namespace tegotae::bench
