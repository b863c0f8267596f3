# Installs the build into an empty folder and compiles a program against sinew.pc and against the
# CMake package. BUILD is the build folder.
. "$SOURCE/tests/cli/lib.sh"

cmake --install "$BUILD" --prefix "$PWD/prefix" >install.log
library=$(dirname "$(find prefix -name sinew.pc)")/..
# compiling without the flags must fail, or the test shows nothing
! cc "$SOURCE/tests/install/relax.c" -o without 2>/dev/null || die "compiled without sinew.pc"
flags=$(PKG_CONFIG_PATH="$library/pkgconfig" pkg-config --cflags --libs sinew)
cc "$SOURCE/tests/install/relax.c" $flags ${SANITIZE:+-fsanitize=$SANITIZE} -o relax-pc
[ "$(LD_LIBRARY_PATH=$library ./relax-pc)" = 0.730748613 ] || die "wrong result through sinew.pc"

cc "$SOURCE/examples/embed/poke.c" $flags ${SANITIZE:+-fsanitize=$SANITIZE} -o poke
LD_LIBRARY_PATH=$library ./poke >poke.log || die "the embedding example: $(cat poke.log)"

cc "$SOURCE/examples/embed/haptic.c" $flags ${SANITIZE:+-fsanitize=$SANITIZE} -lm -o haptic
LD_LIBRARY_PATH=$library ./haptic 0.3 >haptic.log || die "the haptic example: $(cat haptic.log)"
[ "$(awk '/ ms / { n += $4 } END { print n }' haptic.log)" = 300 ] || die "frames: $(cat haptic.log)"

cmake -S "$SOURCE/tests/install" -B outside -DCMAKE_PREFIX_PATH="$PWD/prefix" \
    ${SANITIZE:+-DCMAKE_C_FLAGS=-fsanitize=$SANITIZE} >cmake.log
cmake --build outside >>cmake.log
[ "$(outside/relax)" = 0.730748613 ] || die "wrong result through the CMake package"

[ "$(prefix/bin/sinew --version | cut -d' ' -f1)" = sinew ] || die "the installed command does not run"
