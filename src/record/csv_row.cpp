#include "record/csv_row.hpp"

#include <charconv>

namespace tegotae {

const char* const kRecordHeader =
    "tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,"
    "fx,fy,fz,tx,ty,tz,contacts,gap,tick_us,lag_reason\n";

namespace {

class Row {
 public:
  explicit Row(char* begin) : begin_(begin), end_(begin) {}
  template <class Number>
  Row& operator<<(Number value) {
    if (end_ != begin_) *end_++ = ',';
    end_ = std::to_chars(end_, begin_ + kMaxRecordRow, value).ptr;
    return *this;
  }
  Row& operator<<(const Vec3& v) { return *this << v.x() << v.y() << v.z(); }
  Row& operator<<(const Pose& X) { return *this << X.p << X.q.w() << X.q.x() << X.q.y() << X.q.z(); }
  std::size_t finish() {
    *end_++ = '\n';
    return end_ - begin_;
  }

 private:
  char* begin_;
  char* end_;
};

}  // namespace

std::size_t format_row(const RecordFrame& f, char* row) noexcept {
  Row out(row);
  out << f.tick << f.substep << f.t << f.y << f.x << f.wrench.force << f.wrench.torque << f.contacts << f.gap
      << f.tick_us << static_cast<int>(f.lag_reason);
  return out.finish();
}

}  // namespace tegotae
