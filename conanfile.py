"""Recipe for Conan 2: `conan create .` in this folder."""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import load


class Tegotae(ConanFile):
    name = "tegotae"
    description = "Six-degree-of-freedom haptic rendering of rigid parts that never pass through each other"
    license = "BSD-3-Clause"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    # The narrow phase needs double precision; libccd's own default is single.
    default_options = {"shared": False, "libccd/*:enable_double_precision": True}
    exports_sources = "CMakeLists.txt", "CMakePresets.json", "LICENSE", "include/*", "src/*"

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, "include", "tegotae", "core", "version.hpp"))
        self.version = re.search(r'TEGOTAE_VERSION_STRING "([0-9.]+)"', header).group(1)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        self.requires("fcl/0.7.0")
        self.requires("libccd/2.1")
        self.requires("xxhash/0.8.2")
        self.requires("assimp/5.2.2")
        self.requires("draco/1.5.6")
        self.requires("meshoptimizer/0.20")
        self.requires("minizip/1.3.1")
        self.requires("pugixml/1.14")
        self.requires("tomlplusplus/3.3.0")
        self.requires("nlohmann_json/3.11.3")
        self.requires("zlib/[>=1.2.11 <2]")
        self.requires("zstd/[>=1.5 <1.6]")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name in ("APPS", "TESTS"):
            toolchain.cache_variables[f"TEGOTAE_BUILD_{name}"] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The installed CMake files are used as they are.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "tegotae")]
        self.cpp_info.libs = ["tegotae"]
        self.cpp_info.system_libs = ["pthread", "rt"]
