// What the notes of the import say of parts. docs/formats.md lists them, which `ctest -R doc_formats` checks.
#pragma once

#include "import/import_notes.hpp"

namespace tegotae::note_texts {

// STEP: facets and their chords.
inline constexpr NoteText kReachesIn{
    "", "parts", "facets of a cylinder reach up to %s into a clearance",
    "less with a smaller --chord where it mates, with a smaller --coarse-chord elsewhere"};
inline constexpr NoteText kBent{
    "", "parts", "a plane that runs into a hole tangentially is bent by up to %s",
    "less with a smaller --chord where the hole mates, with a smaller --coarse-chord elsewhere"};
inline constexpr NoteText kTurned{
    "", "parts", "facets beside a hole were turned over",
    "they stay as they are with a smaller --chord where the hole mates, with a smaller --coarse-chord elsewhere"};
inline constexpr NoteText kMayMate{"", "pairs of parts",
                                   "may mate in such faces, whose facets reach up to %s into the clearance",
                                   "for a fit with less play take a smaller --chord"};

// STEP: what the surfaces lack.
inline constexpr NoteText kNoTriangles{"", "parts", "no triangles could be made there, so there is a hole",
                                       "export the part anew, or as a mesh"};
inline constexpr NoteText kNotClosed{"", "parts", "not closed, so the inside is not known",
                                     "if it is to be a solid, sew it in the CAD program"};
inline constexpr NoteText kTrianglesNotClosed{"", "parts", "triangles that are not closed, so the inside is not known",
                                              "if it is to be a solid, export it exactly, not as triangles"};

// STEP: what is left out.
inline constexpr NoteText kNoFaces{"", "parts", "no faces, so left out",
                                   "if it is a body, export it as a solid or as surfaces"};
inline constexpr NoteText kLines{"", "parts", "curves and points beside the faces are left out",
                                 "what is to be touched has to be a solid or a surface"};
inline constexpr NoteText kUnread{"", "shapes", "not read, so left out",
                                  "export the part as a boundary representation (B-rep), or as a mesh"};
inline constexpr NoteText kNoProduct{"the triangles of ", "sets of triangles", "of no product, so left out",
                                     "export them as the shape of a part"};
inline constexpr NoteText kMissingFile{"the file ", "files", "named in this one and missing, so left out",
                                       "put it beside this file, or export all into one"};
inline constexpr NoteText kUnplaced{"the instance ", "instances",
                                    "without a place, so read only where the shape of the assembly has it",
                                    "place it in the CAD program and export anew"};
inline constexpr NoteText kSharedShape{"the products ", "groups of products",
                                       "one shape between several products, of which one product is made",
                                       "export each with a shape of its own if a part is missing"};
inline constexpr NoteText kNoColors{"", "files", "colors are damaged and not read",
                                    "`color` in the scene file gives a part its color"};

// STEP: what is read otherwise than it may be meant.
inline constexpr NoteText kHidden{"", "bodies", "hidden in the file, and read all the same",
                                  "if one is not a part, take it out of the file or of the scene"};
inline constexpr NoteText kNoUnit{"", "shapes",
                                  "no unit of length, so taken for mm, or for the unit of the shape around it",
                                  "export the file with its unit"};
inline constexpr NoteText kNoAngle{"", "shapes", "no unit of angle, so the angles of cones are taken for degrees",
                                   "export the file with its units"};

// glTF and 3MF.
inline constexpr NoteText kEmptyMesh{"", "parts", "no triangles, so left out",
                                     "if it is a body, export it as a mesh of triangles"};
inline constexpr NoteText kScaledAway{"", "parts", "scaled to nothing, so left out",
                                      "some programs hide parts so: show it and export anew"};
inline constexpr NoteText kFlat{"", "parts", "scaled to nothing in some direction, so a sheet without a volume",
                                "if it is to be a solid, give it its thickness and export anew"};
inline constexpr NoteText kUnreadShape{"", "objects", "an element that is not read instead of a mesh, so left out",
                                       "export it as a mesh of triangles"};
inline constexpr NoteText kSupport{"", "objects", "a support of the print, so left out",
                                   "if it is a part, give its object the type model"};
inline constexpr NoteText kOther{"", "objects", "of the type other, which is nothing to be made, so left out",
                                 "if it is a part, give its object the type model"};
inline constexpr NoteText kLattice{"", "objects", "its beam lattice is not read", "export the lattice as triangles"};
inline constexpr NoteText kSlices{"", "objects",
                                  "printed from slices, which are not read: its mesh is a coarse stand-in",
                                  "export it with its full mesh"};

}  // namespace tegotae::note_texts
