#include <array>
#include <charconv>

#include "review/path_exports.hpp"
#include "shared/csv_cell.hpp"

namespace tegotae::review {
namespace {

constexpr double kKeyEvery = 0.01;  // s

void add(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  if (!text.empty() && text.back() != '\n') text += ',';
  text.append(digits.data(), end);
}

void add(std::string& text, const Pose& X) {
  for (const double x : X.p) add(text, x);
  for (const double x : {X.q.w(), X.q.x(), X.q.y(), X.q.z()}) add(text, x);
}

}  // namespace

std::string path_csv(const Scene& scene, const std::vector<RecordFrame>& rows, const Scan& scan,
                     const std::optional<BandFindings>& band) {
  std::string text = "t,px,py,pz,qw,qx,qy,qz,clearance,part,force,torque";
  text += band ? ",band\n" : "\n";
  for (std::size_t i = 0; i < scan.rows.size(); ++i) {
    const ScannedRow& s = scan.rows[i];
    const RecordFrame& row = rows[s.row];
    add(text, row.t);
    add(text, row.x);
    if (s.clearances.empty()) {
      text += ",inf,";
    } else {
      add(text, s.clearances.front().distance);
      text += ',' + apps::csv_cell(scene.parts[s.clearances.front().part].name);
    }
    add(text, row.wrench.force.norm());
    add(text, row.wrench.torque.norm());
    if (band) text += std::string(",") + to_string(band->of_row[i]);
    text += '\n';
  }
  return text;
}

std::string path_script(const SceneFile& file, const std::vector<RecordFrame>& rows, const Vec3& center) {
  const HandSettings& hand = file.device.hand;
  const Pose& first = rows.front().y;
  // Where the hand was at a row: its spring balances what the pen met. The part goes `scale` times the pen's way.
  const auto hand_at = [&](const RecordFrame& row) {
    const Displacement gone = displacement(first, row.y, center);
    const Displacement lead = {-row.wrench.force / hand.stiffness, -row.wrench.torque / hand.torsional_stiffness};
    return displaced(displaced(row.y, center, {(1 / file.scene.scale - 1) * gone.dp, Vec3::Zero()}), center, lead);
  };
  std::string text = "t,px,py,pz,qw,qx,qy,qz\n";
  const double begin = rows.front().t;
  const auto key = [&](double t, const Pose& X) {
    add(text, t - begin);
    add(text, X);
    text += '\n';
  };
  key(begin, first);
  for (std::size_t i = 1; i < rows.size();) {
    // The mean over a step, for a reported pose comes in steps of the device's resolution.
    const double until = rows[i].t + kKeyEvery;
    const Pose base = hand_at(rows[i]);
    Displacement sum;
    double t = 0;
    std::size_t n = 0;
    for (; i < rows.size() && rows[i].t < until; ++i, ++n) {
      const Displacement d = displacement(base, hand_at(rows[i]), center);
      sum.dp += d.dp;
      sum.dr += d.dr;
      t += rows[i].t;
    }
    const double share = 1 / static_cast<double>(n);
    if (t * share > begin) key(t * share, displaced(base, center, share * sum));
  }
  return text;
}

}  // namespace tegotae::review
