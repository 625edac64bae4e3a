#!/bin/sh
# Tries every recipe whose tool is here: builds, installs into an empty prefix, links packaging/program.c against it, runs it. Prints a line
# for each; ends with 1 where one fails. Tools that are not here are told. Usage: sh packaging/try.sh [FOLDER]
#
# Each recipe compiles the library itself, which takes minutes. With HBVIB_BUILT=FOLDER the libraries in FOLDER/release are taken as
# built: `cargo build` then does nothing, all else is done.
set -u
cd "$(dirname "$0")/.."
root=$PWD
work=${1:-$root/target/packaging}
rm -rf "$work"
mkdir -p "$work/bin"
work=$(cd "$work" && pwd)
real=$(command -v cargo)
if [ -n "${HBVIB_BUILT:-}" ]; then
    export CARGO_TARGET_DIR=$HBVIB_BUILT
    printf '#!/bin/sh\n[ "$1" != build ] || exit 0\nexec "%s" "$@"\n' "$real" >"$work/bin/cargo"
    chmod 755 "$work/bin/cargo"
    export CARGO="$work/bin/cargo"
    PATH=$work/bin:$PATH
fi
failed=0
try() { # name, tool, function
    if ! command -v "$2" >/dev/null 2>&1; then
        printf '%-22s not tried: no %s here\n' "$1" "$2"
        return
    fi
    mkdir -p "$work/$3"
    (set -e; cd "$work/$3"; "$3") >"$work/$3.log" 2>&1
    if [ $? = 0 ] && grep -q "resonance at 1.23202" "$work/$3.log"; then
        printf '%-22s passed\n' "$1"
    else
        printf '%-22s FAILED: %s\n' "$1" "$work/$3.log"
        failed=1
    fi
}
linked() { # prefix: compiler flags by pkg-config
    cc "$root/packaging/program.c" $(PKG_CONFIG_PATH=$1/lib/pkgconfig pkg-config --cflags --libs hbvib) -lm -o program
    ./program
}

install_sh() { sh "$root/examples/install.sh" "$PWD/prefix" && linked "$PWD/prefix"; }
cmake_install() {
    cmake -S "$root/packaging/cmake" -B build -DCMAKE_INSTALL_PREFIX="$PWD/prefix"
    cmake --build build
    cmake --install build
    linked "$PWD/prefix"
}
cpack_packages() {
    cmake -S "$root/packaging/cmake" -B build
    cmake --build build
    (cd build && cpack -G "TGZ;DEB")
    mkdir unpacked
    dpkg-deb -x build/*.deb unpacked
    linked "$PWD/unpacked/usr"
}
conan_create() {
    export CONAN_HOME=$PWD/home
    conan profile detect
    # What the test package builds stays out of the checkout.
    conan create "$root/packaging/conan" -c tools.cmake.cmake_layout:test_folder="$PWD/test" -c tools.cmake.cmaketoolchain:user_presets=
}
debian_packages() {
    # A source tree as a packager has it.
    mkdir source
    (cd "$root" && tar cf - --exclude=./target --exclude=./.git --exclude='./.venv*' .) | (cd source && tar xf -)
    cp -r "$root/packaging/debian" source/debian
    (cd source && dpkg-buildpackage -b -us -uc -d)
    mkdir unpacked
    for package in ./*.deb; do dpkg-deb -x "$package" unpacked; done
    folder=$(dirname "$(find unpacked -name 'libhbvib.so')")
    cc "$root/packaging/program.c" -Iunpacked/usr/include -L"$folder" -lhbvib -lm -Wl,-rpath,"$PWD/$folder" -o program
    ./program
    for package in ./*.deb; do lintian "$package" || true; done
}
meson_subproject() {
    mkdir -p app/subprojects
    ln -s "$root/packaging/meson" app/subprojects/hbvib
    cp "$root/packaging/program.c" app/
    cat >app/meson.build <<'END'
project('app', 'c')
hbvib = subproject('hbvib').get_variable('hbvib_dep')
executable('program', 'program.c', dependencies: [hbvib, meson.get_compiler('c').find_library('m')])
END
    meson setup build app
    meson compile -C build
    build/program
}
fpm_dependency() {
    sh "$root/examples/install.sh" "$PWD/prefix"
    mkdir -p app/app
    cat >app/fpm.toml <<END
name = "app"
version = "0.1.0"
[dependencies]
hbvib-fortran = { path = "$(realpath --relative-to=app "$root/packaging/fpm")" }
[fortran]
implicit-external = false
END
    # fpm reads one statement a line.
    sed -n "/^\`\`\`fortran$/,/^\`\`\`$/p" "$root/docs/first-response.md" | sed "1d;/^\`\`\`$/,\$d;s/; implicit none/\n   implicit none/" >app/app/main.f90
    cd app && fpm run --link-flag "-L$work/fpm_dependency/prefix/lib -Wl,-rpath,$work/fpm_dependency/prefix/lib"
}
python_packages() {
    python=${PYTHON:-python3}
    [ -z "${HBVIB_BUILT:-}" ] || export HBVIB_WHEEL_LIBRARIES="$HBVIB_BUILT/release"
    "$python" -m build --no-isolation --outdir dist "$root"
    "$python" -m venv fresh
    fresh/bin/pip install dist/*.whl
    cd /
    "$work/python_packages/fresh/bin/python" -c '
import hbvib
model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
model.add_force(0, 0.2)
print("resonance at %g" % model.forced_response((0.8, 1.6)).peaks().omega[0])
print(hbvib.__file__, hbvib.get_include())'
    include=$("$work/python_packages/fresh/bin/python" -c 'import hbvib; print(hbvib.get_include())')
    # The wheel is for Python; its headers are those of C all the same.
    cc -fsyntax-only -I"$include" "$root/packaging/program.c"
}

try "install.sh" sh install_sh
try "CMake" cmake cmake_install
try "CPack (TGZ, DEB)" cpack cpack_packages
try "Conan 2" conan conan_create
try "Debian" dpkg-buildpackage debian_packages
try "Meson subproject" meson meson_subproject
try "fpm" fpm fpm_dependency
try "sdist and wheel" python3 python_packages
for tool in vcpkg spack rattler-build; do command -v $tool >/dev/null 2>&1 || printf '%-22s not tried: no %s here\n' $tool $tool; done
exit $failed
