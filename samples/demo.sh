# The demonstration that `make demo` runs: sh samples/demo.sh NCCOMPILE OUTPUT-FOLDER
set -eu
nccompile=$1
out=$2
mkdir -p "$out"

step() {
    echo
    echo "\$ nccompile $*"
    "$nccompile" "$@"
}

step compile samples/bracket.nc -m samples/mill3.toml -o "$out/bracket.ncq"
step info "$out/bracket.ncq"
step run "$out/bracket.ncq" -m samples/mill3.toml --trace "$out/bracket.csv"
step plot "$out/bracket.ncq" -m samples/mill3.toml -o "$out/bracket.png"
echo
echo "The picture is in $out/bracket.png, the set and actual positions of every cycle are in $out/bracket.csv."
