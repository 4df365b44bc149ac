#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tegotae {

/// Reads the values of one entity of a STEP file (ISO 10303-21) from left to right. What is not as expected throws
/// Error "PATH: damaged: #ID ...".
class StepCursor {
 public:
  StepCursor(const std::string& path, std::uint64_t id, std::string_view text) : path_(path), id_(id), text_(text) {}

  /// Whether the next sign is `c`, which is then passed.
  bool take(char c);
  void expect(char c);
  /// A word such as COORDINATES_LIST; empty when there is none.
  std::string_view word();
  double number();
  std::uint64_t index();      ///< a whole number from 1 on
  std::uint64_t reference();  ///< of #17 the 17
  std::uint64_t optional();   ///< the same; 0 for `$` and `*`
  /// Passes one value of any kind, however deep.
  void skip();
  bool at_end();
  /// Calls `each` at every value of a list `(a, b, ...)`.
  template <class Each>
  void list(Each each) {
    expect('(');
    if (take(')')) return;
    do each();
    while (take(','));
    expect(')');
  }
  /// What has not been read yet.
  std::string_view rest();
  [[noreturn]] void damaged(const std::string& why) const;

 private:
  void skip_blank();

  const std::string& path_;
  std::uint64_t id_;
  std::string_view text_;
};

/// A piece of a STEP file up to its `;`.
struct StepStatement {
  std::uint64_t id = 0;    ///< of an entity `#id = ...`; 0: something else
  std::string_view text;   ///< all of it, the `;` and what stands before it too
  std::string_view value;  ///< of an entity: what follows the `=`, without the `;`
};

/// All statements of a STEP file, in order, with nothing left out between them. Throws Error when a text or comment
/// does not end, or the number of an entity is too large for OpenCASCADE.
std::vector<StepStatement> step_statements(const std::string& path, std::string_view bytes);

/// The text of a STEP file as OpenCASCADE reads it: without byte order mark and comments, its data sections (edition
/// 2 on) one, its anchors left out. Throws Error when it refers to entities of other files, or a text or comment does
/// not end.
std::string plain_step(const std::string& path, std::string bytes);

}  // namespace tegotae
