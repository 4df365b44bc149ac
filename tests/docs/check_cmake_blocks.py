#!/usr/bin/env python3
"""Every ```cmake block of README.md and docs/*.md configures: check_cmake_blocks.py BUILD_FOLDER. Each is put into a project
of its own with a program `my_program`, beside the library installed from BUILD_FOLDER and a copy of the sources in
`tegotae` (a link)."""
import glob
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BLOCK = re.compile(r"^```cmake\n(.*?)^```$", re.M | re.S)
HEAD = "cmake_minimum_required(VERSION 3.21)\nproject(user LANGUAGES C CXX)\nadd_executable(my_program my_program.cpp)\n"


def run(*command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return result.returncode, result.stdout


def main():
    build, count = os.path.abspath(sys.argv[1]), 0
    with tempfile.TemporaryDirectory() as work:
        prefix = os.path.join(work, "installed")
        for component in ("development", "library"):
            code, output = run("cmake", "--install", build, "--prefix", prefix, "--component", component)
            if code != 0:
                sys.exit(output)
        for page in [os.path.join(ROOT, "README.md")] + sorted(glob.glob(os.path.join(ROOT, "docs", "*.md"))):
            with open(page, encoding="utf-8") as file:
                blocks = BLOCK.findall(file.read())
            for block in blocks:
                count += 1
                project = os.path.join(work, str(count))
                os.mkdir(project)
                os.symlink(ROOT, os.path.join(project, "tegotae"))
                with open(os.path.join(project, "CMakeLists.txt"), "w", encoding="utf-8") as file:
                    file.write(HEAD + block)
                with open(os.path.join(project, "my_program.cpp"), "w", encoding="utf-8") as file:
                    file.write("int main() {}\n")
                code, output = run("cmake", "-S", project, "-B", os.path.join(project, "build"),
                                   "-DCMAKE_PREFIX_PATH=" + prefix)
                if code != 0:
                    sys.exit("%s: this block does not configure:\n%s\n%s" % (page, block, output))
    if count == 0:
        sys.exit("no blocks found")
    print("%d blocks" % count)


main()
