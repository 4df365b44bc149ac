#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tegotae {

/// What a note says of the things that it is about.
struct NoteText {
  const char* one;     ///< stands before a thing that is alone: "the file "
  const char* many;    ///< what several things are: "parts"
  const char* what;    ///< `%s` stands for the largest value, um
  const char* advice;  ///< what to do about it
};

/// Notes of an import, a line for each text however many parts it is said of: with their number and the first few.
class ImportNotes {
 public:
  /// Says `text`, which outlives this, of `thing`: a name in quotes, or the number of an entity. `value`, m.
  void add(const NoteText& text, const std::string& thing, double value = 0);
  /// Adds a line for each text, in the order in which they were first said: `2 parts ("a", "b"): WHAT; ADVICE`.
  void write_to(std::vector<std::string>& notes) const;

 private:
  struct Said {
    const NoteText* text;
    std::vector<std::string> first;  // things, some of them
    std::size_t count = 0;
    double largest = 0;
  };
  std::vector<Said> said_;
};

}  // namespace tegotae
