# The completion of flexmech-plot, flexmech-report, flexmech-import and flexmech-export in bash, from its --help:
#   flexmech-plot --help | awk -f completion.awk > flexmech-plot
# An option with a value has it in capitals behind its name, FILE if it is that of a file; values that are few stand first in
# what the option is for, as in `png, svg or pdf; …`. Other words are folders, where the usage says FOLDER, or files.

/^usage: / {
    name = $2
    words_are = $0 ~ /FOLDER/ ? "-d" : "-f"
}

/^  -/ {
    count = split($0, words, /[ ,]+/)
    for (i = 2; i <= count && words[i] ~ /^-/; i++) options = options " " words[i]
    if (words[i] !~ /^[A-Z]+$/) next
    value = $0
    sub(/^  -[^ ]* [A-Z]*  */, "", value)
    choices = value ~ /^[a-z]+(, [a-z]+)* or [a-z]+;/ ? value : ""
    sub(/;.*/, "", choices)
    gsub(/, | or /, " ", choices)
    valued[++number] = words[2]
    of[number] = choices
    is_file[number] = words[i] == "FILE"
}

END {
    function_name = "_" name
    gsub(/-/, "_", function_name)
    print "# Completion of " name " in bash."
    print function_name "() {"
    print "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}"
    print "  COMPREPLY=()"
    # bash takes the = of --format=svg for a word.
    print "  if [[ $word == = ]]; then"
    print "    word="
    print "  elif [[ $before == = ]]; then"
    print "    before=${COMP_WORDS[COMP_CWORD-2]}"
    print "  fi"
    print "  case $before in"
    for (i = 1; i <= number; i++) {
        print "    " valued[i] ")"
        if (of[i] != "") print "      mapfile -t COMPREPLY < <(compgen -W '" of[i] "' -- \"$word\")"
        if (is_file[i]) print "      compopt -o filenames\n      mapfile -t COMPREPLY < <(compgen -f -- \"$word\")"
        print "      return ;;"
    }
    print "  esac"
    print "  if [[ $word == -* ]]; then"
    print "    mapfile -t COMPREPLY < <(compgen -W '" substr(options, 2) "' -- \"$word\")"
    print "  else"
    print "    compopt -o filenames"
    print "    mapfile -t COMPREPLY < <(compgen " words_are " -- \"$word\")"
    print "  fi"
    print "}"
    print "complete -F " function_name " " name
}
