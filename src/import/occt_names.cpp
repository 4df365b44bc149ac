#include "import/occt_names.hpp"

#include <TDataStd_Name.hxx>
#include <cctype>

#include "import/made_up_name.hpp"

namespace tegotae {

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  const TCollection_ExtendedString& text = name->Get();
  std::string bytes(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  Standard_PCharacter at = bytes.data();
  bytes.resize(static_cast<std::size_t>(text.ToUTF8CString(at)));
  return bytes;
}

bool is_default_name(const std::string& name) {
  if (name.empty() || name.rfind("=>", 0) == 0) return true;
  // Numbers alone are what many companies call their parts.
  if (std::isalpha(static_cast<unsigned char>(name[0])) == 0) return false;
  return is_made_up(name, {"solid", "compound", "compsolid", "shell", "face", "wire", "edge", "vertex", "shape",
                           "assembly", "open cascade step translator"});
}

}  // namespace tegotae
