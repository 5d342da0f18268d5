# What unit tests and the modules that only they use depend on (makedepf90 does not read .pf); `known`: the modules that there are.
# What a test uses stands at the head of its lines.
/^ *use +[a-z]/ {
  module = $2
  sub(/[^a-z0-9_].*/, "", module)
  name = FILENAME
  sub(/.*\//, "", name)
  is_test = sub(/\.pf$/, "", name)
  sub(/\.f90$/, "", name)
  if (index(known, " " module " ") && module != name)
    print (is_test ? "$(build)/funit/" name ".o $(build)/pfunit/" name ".o" : "$(build)/" name ".o") ": $(build)/" module ".o"
}
