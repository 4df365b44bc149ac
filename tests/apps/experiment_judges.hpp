// Judges of the experiments that do not take the program's word: they read its tables and know the scenes by heart.
#pragma once

#include <string>

namespace tegotae::test {

/// Whether `value` meets `target` ("at most 1", "at least 99"); throws std::invalid_argument for another form.
bool meets(double value, const std::string& target);

/// Checks the tables of experiment `name` in the folder `at` with Catch.
void judge_tables(const std::string& name, const std::string& at);

}  // namespace tegotae::test
