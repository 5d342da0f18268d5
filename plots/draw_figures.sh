#!/bin/sh
# Draws every figure that the tables of one deck allow, into the folder `figures` beside them (the linkage that draws the
# paths of points, as an animated GIF too), or animates all that moves in them, into the folder `animations`. This is the
# command flexmech-plot; `draw_figures.sh --help` lists its options.
# A figure of the thesis gets its number (thesis_figures.txt). The figures of the last run in the same format stay until new ones
# are drawn; then they go, and files that this script did not draw stay. Prints a line a figure.

set -u
LC_ALL=C
export LC_ALL
command=${FLEXMECH_PLOT-draw_figures.sh}

fail() {
    printf '%s: %s\n' "$command" "$1" >&2
    exit "${2:-1}"
}

remark() { printf '%s: %s\n' "$command" "$1" >&2; }

# On the command line: say how to call it.
misused() {
    remark "$1"
    [ "$command" = make ] || printf "'%s --help' lists the options\n" "$command" >&2
    exit 2
}

help() {
    cat << END_OF_HELP
usage: $command [options] FOLDER...

Draws the figures that the tables of a deck allow, into FOLDER/figures; FOLDER is what flexmech
has written, such as outputs/mechanism1.

  --animate        animate the linkage and its modes instead, as GIFs, into FOLDER/animations
  --each           a figure for every speed, where more than four would be one page
  --errors         draw the estimated errors of the frequencies too
  --format FORMAT  png, svg or pdf; several with commas between, side by side; default: png
  --only FIGURE    no others, such as campbell; several with commas between, or in several options
  --overlay POINTS measured points over a curve: FILE.csv:X:Y, columns by number or name
  --size SIZE      of every figure: WIDTHxHEIGHT in pixels, such as 1200x800, or in millimetres,
                   such as 160x100mm; default: 1600 pixels wide, as high as it needs to be
  --style FILE     of gnuplot, read last, for colours, fonts and lines of your own
  --no-titles      no heading and no notes, for figures with a caption of their own
  --help, --version

Exit status: 0, 1 if something could not be drawn, 2 if the command line is wrong.
END_OF_HELP
}

# size_words SIZE: width, height and unit of 1200x800 or 160x100mm, if that is a size.
size_words() {
    case $1 in *[!0-9xpm]*) return ;; esac
    printf '%s\n' "$1" | sed -n 's/^\([0-9][0-9]*\)x\([0-9][0-9]*\)$/\1 \2 px/p; s/^\([0-9][0-9]*\)x\([0-9][0-9]*\)\(px\|mm\)$/\1 \2 \3/p' |
        awk '{ least = $3 == "mm" ? 40 : 150; most = $3 == "mm" ? 2000 : 10000 }
            $1 >= least && $1 <= most && $2 >= least && $2 <= most'
}

figures=figures
format=
size=
titles=yes
errors=no
each=no
only=
style=
overlays=
wanted=
options=
newline='
'
ended=
while [ $# -gt 0 ]; do
    option=${1%%=*}
    case $option in
        --format | --size | --only | --style | --overlay)
            case $1 in
                *=*) value=${1#*=} ;;
                *)
                    [ $# -gt 1 ] || misused "$option takes a value"
                    value=$2
                    shift ;;
            esac
            [ -n "$value" ] || misused "$option takes a value"
            case $option in
                --format) format=$value ;;
                --size) size=$value ;;
                --only) only=$only,$value ;;
                --style) style=$value ;;
                --overlay) overlays=$overlays$value$newline ;;
            esac ;;
        --animate | --each | --errors | --no-titles | --help | --version)
            [ "$option" = "$1" ] || misused "$option takes no value: $1"
            case $option in
                --animate) figures=animations ;;
                --each) each=yes ;;
                --errors) errors=yes ;;
                --no-titles) titles=no ;;
                *) wanted=$option ;;
            esac ;;
        --)
            ended=yes
            shift
            break ;;
        -?*) misused "unknown option $1" ;;
        *) break ;;
    esac
    shift
done
# typed OPTION: as it was, which at make has another name.
typed() { [ "$command" = make ] && printf '%s=' "$1" | tr a-z A-Z || printf -- '--%s ' "$1"; }
for folder in "$@"; do
    case $ended${folder%%=*} in
        --animate | --each | --errors | --no-titles | --format | --only | --overlay | --size | --style | --help | --version)
            misused "options stand before the folder: $folder" ;;
    esac
done
[ -z "$format" ] || printf '%s\n' "$format" | awk 'NR > 1 || !/^(png|svg|pdf)(,(png|svg|pdf))*$/ { exit other = 1 } END { exit other }' ||
    misused "$(typed format)$format: png, svg or pdf, or several of them with commas between"
# Figures by their names without speed, parameter and number; those that figures.txt has not are named here.
known_figures() {
    {
        sed -n 's/^figures  *\([^ ]*\) .*/\1/p' "$PLOTS/figures.txt"
        echo "balance coupler_curve drive_locus errors finite_element_model frequencies frequency growth kinematics_accelerations \
            kinematics_angles kinematics_velocities linkage linkage_positions mechanism mode modes shaking_force strains summary" | tr -s ' ' '\n'
    } | sort -u
}
settings="figure_format = '$format'; figure_titles = $([ $titles = no ]; echo $?); figure_width = 0"
if [ -n "$size" ]; then
    set_size=$(size_words "$size")
    [ -n "$set_size" ] ||
        misused "$(typed size)$size: WIDTHxHEIGHT of 150 to 10000 pixels or 40 to 2000 mm each, such as 1200x800 or 160x100mm"
    settings="$settings; $(echo "$set_size" | awk '{ printf "figure_width = %d; figure_height = %d; figure_unit = \"%s\"", $1, $2, $3 }')"
fi
if [ $figures = animations ]; then
    [ -z "$format$size$only$overlays" ] && [ $errors = no ] && [ $each = no ] ||
        misused '--animate takes no --format, --size, --errors, --each, --only or --overlay: an animation is a GIF of fixed size'
fi

script=$0
while [ -h "$script" ]; do
    target=$(readlink -- "$script")
    case $target in
        /*) script=$target ;;
        *) script=$(dirname -- "$script")/$target ;;
    esac
done
PLOTS=$(CDPATH='' cd -- "$(dirname -- "$script")" && pwd) || exit 1
export PLOTS
for one in $(printf '%s' "$only" | tr ', ' '\n\n'); do
    known_figures | grep -qxF -e "$one" || misused "$(typed only)$one: expected one of $(known_figures | paste -s -d' ' -)"
done

# style_fault FILE: what gnuplot says to it.
style_fault() {
    FILE=$1 awk "$quoting"'BEGIN { print "set terminal dumb; figure_style = " quoted(ENVIRON["FILE"]) "; call " quoted(ENVIRON["PLOTS"] "/style.gp") }' |
        LC_ALL=C.UTF-8 gnuplot - 2>&1 | sed -n '/[^ ^]/{s/^ *//; /^gnuplot>/d; p; q;}'
}
# absolute PATH
absolute() { case $1 in /*) printf '%s' "$1" ;; *) printf '%s/%s' "$(pwd)" "$1" ;; esac; }
# A text as gnuplot reads it, for awk.
quoting=$(cat "$PLOTS/quoted.awk")
if [ -n "$style" ]; then
    [ -f "$style" ] && [ -r "$style" ] || misused "$(typed style)$style: no such file; expected one with commands of gnuplot"
    style=$(absolute "$style")
    ! command -v gnuplot > /dev/null || fault=$(style_fault "$style")
    [ -z "${fault-}" ] || misused "$(typed style)$style: gnuplot says: $fault"
    settings="$settings; figure_style = $(FILE=$style awk "$quoting"'BEGIN { print quoted(ENVIRON["FILE"]) }')"
fi

# Linkages are placed by the program: the one that FLEXMECH names, else that of this checkout, the one installed with these
# scripts, or any other.
places() { [ -n "$1" ] && "$1" --help-cards 2> /dev/null | grep -q '^REPORT geometry'; }
if [ -n "${FLEXMECH-}" ]; then
    places "$FLEXMECH" || fail "FLEXMECH=$FLEXMECH is not the program flexmech of these scripts" 2
else
    for FLEXMECH in "$PLOTS/../build/release/flexmech" "$PLOTS/../../../bin/flexmech" "$(command -v flexmech)" ''; do
        places "$FLEXMECH" && break
    done
fi
case $FLEXMECH in */*) FLEXMECH=$(CDPATH='' cd -- "$(dirname -- "$FLEXMECH")" && pwd)/${FLEXMECH##*/} ;; esac
export FLEXMECH

if [ "$wanted" = --version ]; then
    version=$(${FLEXMECH:+"$FLEXMECH" --version})
    printf '%s %s\n' "$command" "${version#flexmech }"
    exit
fi
# Points to lay over: the file, two columns behind colons, and what overlay.awk makes of them, with its names and units.
check_overlay() {
    y=${1##*:}
    rest=${1%:*}
    points=${rest%:*}
    [ "$rest" != "$1" ] && [ "$points" != "$rest" ] && [ -n "$y" ] && [ -n "${rest##*:}" ] ||
        misused "$(typed overlay)$1: expected FILE:X:Y, a file and two of its columns by number or name"
    [ -f "$points" ] && [ -r "$points" ] || misused "$(typed overlay)$1: no file $points; expected FILE:X:Y"
    found=$(X=${rest##*:} Y=$y awk "BEGIN { at = ENVIRON[\"X\"]; over = ENVIRON[\"Y\"] } $(cat "$PLOTS/overlay.awk")" < "$points") ||
        misused "$(typed overlay)$1: ${found##*!}"
}
IFS_before=$IFS
IFS=$newline
absolute_overlays=
for one in $overlays; do
    IFS=$IFS_before
    check_overlay "$one"
    absolute_overlays=$absolute_overlays$(absolute "$one")$newline
done
IFS=$IFS_before
overlays=$absolute_overlays
if [ "$wanted" = --help ]; then
    help
    exit
fi
[ $# -gt 0 ] || misused 'the folder with the tables of a deck is missing'

case $format in *,*) formats=$(echo "$format" | tr , ' ') ;; *) formats= ;; esac
if [ $# -gt 1 ] || [ -n "$formats" ]; then
    status=0
    trap 'kill ${!-} 2> /dev/null; wait; exit 130' INT
    trap 'kill ${!-} 2> /dev/null; wait; exit 143' TERM HUP
    for folder in "$@"; do
        for format in ${formats:-${format:--}}; do
            [ "$format" = - ] && format=
            # A shell obeys a signal while it waits, not while it runs something.
            (
                set -- -- "$folder"
                [ $figures = figures ] || set -- --animate "$@"
                [ $each = no ] || set -- --each "$@"
                [ $errors = no ] || set -- --errors "$@"
                [ $titles = yes ] || set -- --no-titles "$@"
                [ -z "$format" ] || set -- --format "$format" "$@"
                [ -z "$size" ] || set -- --size "$size" "$@"
                [ -z "$only" ] || set -- --only "$only" "$@"
                [ -z "$style" ] || set -- --style "$style" "$@"
                IFS=$newline
                for one in $overlays; do set -- --overlay "$one" "$@"; done
                exec sh "$PLOTS/draw_figures.sh" "$@"
            ) &
            wait $! || { of_one=$?; [ $# -gt 1 ] && status=1 || status=$of_one; }
        done
    done
    exit $status
fi
outdir=${1%/}
# No name for `cd` that begins with a dash, or that CDPATH leads elsewhere.
case $1 in /*) folder=$1 ;; *) folder=${1:+./$1} ;; esac
[ ! -f "$folder" ] || fail "$outdir is a file: name the folder with the tables of a deck, such as outputs/mechanism1" 2
[ -d "$folder" ] || fail "no folder $outdir" 2
command -v gnuplot > /dev/null || fail 'gnuplot is not installed; only figures and animations need it (Debian: gnuplot-nox)'

cd "$folder" || fail "cannot enter $outdir"
new=.figures.$$
drawing=
first=
# A process that begins just now may not hear the signal; without the folder it can draw nothing.
trap '{ rm -rf $new; [ -z "$drawing" ] || { kill $first ${!-}; wait; rm -rf $new; }; } 2> /dev/null' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP
trap 'exit 141' PIPE
# Such a folder of a run that was killed goes. That of one that lives is locked, whatever the number of its process means here.
[ ! -d $new ] || flock -n $new rm -rf $new
mkdir $new $new/wrong || fail "cannot write into $outdir"
exec 8< $new && flock 8 2> /dev/null
for left in .figures.[0-9]*; do
    number=${left#.figures.}
    case $number in *[!0-9]*) continue ;; esac
    [ ! -d "$left" ] || kill -0 "$number" 2> /dev/null || ! flock -n "$left" true || mv "$left" $new
done

overlay=0
IFS=$newline
for one in $overlays; do
    IFS=$IFS_before
    overlay=$((overlay + 1))
    check_overlay "$one"
    printf '%s\n' "$found" | sed 1d > "$new/overlay_$overlay"
    title=${points##*/}
    settings="$settings; overlays = $overlay; $(TITLE=${title%.*} FILE=$new/overlay_$overlay HEAD=$(printf '%s\n' "$found" | sed 1q) awk -v k=$overlay "$quoting"'BEGIN {
        split(ENVIRON["HEAD"], part, "|")
        printf "overlay_%d = %s; overlay_title_%d = %s; overlay_x_%d = %s; overlay_x_unit_%d = %s; overlay_y_%d = %s; overlay_y_unit_%d = %s", k, \
            quoted(ENVIRON["FILE"]), k, quoted(ENVIRON["TITLE"]), k, quoted(part[1]), k, quoted(part[2]), k, quoted(part[3]), k, quoted(part[4])
    }')"
done
IFS=$IFS_before
settings="$settings; overlaid = '$new/overlaid'"

# ask WANT TABLE: see tables.awk
ask() { awk -v want="$1" -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$2"; }

remark_once() {
    grep -qxF -e "$1" "$new/remarks" 2> /dev/null || remark "$1"
    printf '%s\n' "$1" >> "$new/remarks"
}

# have TABLE: it is there and has rows.
have() {
    [ -f "$1" ] || return 1
    grep -qv -e '^#' -e '^ *$' "$1" && return 0
    remark_once "$outdir/$1 has no row that could be computed"
    return 1
}

# Columns of its table that the next figure draws, where it does not draw all, or `columns=` of a REPORT card may leave them out; with a + those
# without which it draws the others. f stands for f1, f2, …
needed=

# complete FIGURE TABLE: the table has these columns; what it lacks is told once.
complete() {
    [ -n "$needed" ] && [ -n "$2" ] || return 0
    its_columns=" $(ask facts "$2" | tr ';' '\n' | sed -n 's/^ col_\([^ ]*\) = .*/\1/p' | tr '\n' ' ')"
    lacking=
    for column in $needed; do
        case $column$its_columns in +* | *" $column "*) ;; *) lacking="$lacking $column" ;; esac
    done
    [ -n "$lacking" ] || return 0
    remark_once "$1 is not drawn: $outdir/${2##*/} has no column$lacking (columns= of its REPORT card)"
    return 1
}

# sound FIGURE TABLE…: there are numbers and names in the tables where the figure needs them; what else there is, is
# told at the end.
sound() {
    of_figure=$1
    wanted=" - $(echo "$needed" | tr -d +) "
    shift
    for of_table in "$@"; do
        of_table=${of_table##*/}
        case $of_table in *.dat) [ -f "$of_table" ] || continue ;; *) continue ;; esac
        [ -f "$new/wrong/$of_table" ] || ask wrong "$of_table" > "$new/wrong/$of_table"
        while read -r column fault; do
            case $wanted in
                ' -  ' | *" $column "* | *" ${column%%[0-9]*} "*)
                    printf '%s %s, %s\n' "$of_figure" "$of_table" "$fault" >> "$new/refused"
                    return 1 ;;
            esac
        done < "$new/wrong/$of_table"
        wanted=' -  '               # of the first table some columns, of others all
    done
}

# asked_for FIGURE KIND: by --only, or for want of it.
asked_for() {
    [ -n "$only" ] || return 0
    stem=$(printf '%s\n' "$1" | sed 's/_\(speed\|crank\|by\)_.*//; s/_by_speed$//; s/_[0-9]*$//')
    case $2 in gauge) stem=strains ;; esac
    case ,$only, in *,"$stem",* | *,"$2",*) ;; *) return 1 ;; esac
}

# add FIGURE KIND TABLE [ASKED [OTHERS]]: see figure.gp
add() {
    asked_for "$1" "$2" || return 0
    sound "$1" "$3" ${5-} && complete "$1" "$3" || return 0
    printf '%s\n' "$1|$2|$3|${4-}|${5-}" >> "$new/plan"
}

# have_modes: frequencies.dat has a frequency.
have_modes() {
    ask facts frequencies.dat | grep -q '; col_f[1-9][0-9]* = ' && return 0
    remark "frequencies are not drawn: $outdir/frequencies.dat has no column f1, f2, … (columns= of its REPORT card)"
    return 1
}

# put_over_time TABLE: a table of a drive with a law has the time before speed and position. Its curves are drawn from a copy with
# the time in the place of the position, and one speed.
put_over_time() {
    mkdir -p "$new/over_time"
    awk '
        function written(line,    n, field, i, text) {
            n = split(line, field, " ")
            # Names and units stand behind a #.
            first = field[1] == "#" ? 2 : 1
            text = first == 2 ? "# " field[first + 1] " " (field[first] == "time" ? "crank" : field[first]) : "0 " field[first]
            for (i = first + 3; i <= n; i++) text = text " " field[i]
            return text
        }
        /^#/ && !body && !/^# *failed / { if (NR > 2) print before; before = last; last = $0; next }
        !body { body = 1; if (NR > 2) { print written(before); print written(last) } }
        { print /^#/ || NF == 0 ? $0 : written($0) }
        END { if (!body) { print written(before); print written(last) } }' < "$1" > "$new/over_time/$1"
}

# A position that shows the mechanism well: the one nearest to 60 degrees.
telling_crank() {
    ask 'distinct crank' "$1" | awk '
        { d = ($1 - 60) % 360; if (d < 0) d += 360; if (d > 180) d = 360 - d }
        NR == 1 || d < least { least = d; best = $1 }
        END { print best }'
}

greatest_speed() { ask 'distinct speed' "$1" | sort -n | tail -n 1; }

# The table of a distributed inertia knows mass centres only.
plan_mechanism() {
    mesh=
    if ask facts inertia.dat | grep -q col_moment; then
        if have mesh.dat; then mesh=mesh.dat; else can_place || return; fi
    fi
    add mechanism mechanism inertia.dat "$(greatest_speed inertia.dat) $(telling_crank inertia.dat)" "$mesh"
}

# named: reads lines of numbers; behind each number the same for a file name, with six digits if they tell it from all others of
# its column.
named() {
    awk '
        function short(number,    text) {
            text = sprintf("%.6g", number)
            return text ~ /e/ ? number : text
        }
        {
            for (i = 1; i <= NF; i++) {
                value[NR, i] = $i
                if (!((i, $i) in met)) times[i, short($i)]++
                met[i, $i] = 1
            }
        }
        END {
            for (n = 1; n <= NR; n++) {
                line = ""
                for (i = 1; i <= NF; i++) {
                    name = short(value[n, i])
                    line = line " " value[n, i] " " (times[i, name] > 1 ? value[n, i] : name)
                }
                print substr(line, 2)
            }
        }'
}

# plan_speeds FIGURE KIND TABLE COLUMNS [OTHERS]: one speed of the table each, unless all these columns (-: any) are zero.
plan_speeds() {
    complete "$1" "$3" || return 0
    speeds=$(ask 'distinct speed' "$3")
    n=$(printf '%s\n' "$speeds" | wc -l)
    speed_names=$(printf '%s\n' "$speeds" | named)
    [ "$4" = - ] || speeds=$(ask "moving speed $(echo "$4" | tr , ' ')" "$3")
    if [ $each = no ] && [ "$(echo "$speeds" | wc -w)" -gt 4 ] && [ $figures = figures ]; then
        add "$1" "$2" "$3" "$(echo $speeds | tr ' ' ';')" "${5-}"
        return
    fi
    for speed in $speeds; do
        name=$1
        [ "$n" -eq 1 ] || name=$1_speed_$(printf '%s\n' "$speed_names" | awk -v speed="$speed" '$1 == speed { print $2; exit }')
        add "$name" "$2" "$3" "$speed" "${5-}"
    done
}

# meets TABLE CONDITION: see figures.txt
meets() {
    case $2 in
        no_law) [ -z "$over" ] ;;
        placed) can_place ;;
        positions) several "$1" ;;
        instants) several "$1" time ;;
        dozen) [ "$(ask 'distinct crank' "$1" | wc -l)" -ge 12 ] ;;
        angles) several "$1" && is_angle "$1" ;;
        speeds) several "$1" speed ;;
        points) ask 'distinct point' "$1" | grep -qv : ;;
    esac
}

# plan_table: the figures or animations of figures.txt.
plan_table() {
    sed -n "s/^$figures  *//p" "$PLOTS/figures.txt" | while read -r figure kind table linkages per conditions others columns needed; do
        case $linkages in any | "$linkage") ;; *) continue ;; esac
        have "$table" || continue
        for condition in $(echo "${conditions#-}" | tr , ' '); do meets "$table" "$condition" || continue 2; done
        [ "$columns" != needed ] || columns=$(echo "$needed" | tr ' ' ,)
        # Over time, where the first table is.
        there=
        for other in $(echo "$others" | tr , ' '); do [ ! -f "$over$other" ] || there="$there $over$other"; done
        [ ! -f "$over$table" ] || table=$over$table
        case $per in
            table) add "$figure" "$kind" "$table" '' "${there# }" ;;
            *) plan_speeds "$figure" "$kind" "$table" "$columns" "${there# }" ;;
        esac
    done
}

plan_frequencies() {
    [ $linkage != structure ] || return 0
    needed=+error
    [ $errors = yes ] && several frequencies.dat && ask facts frequencies.dat | grep -q 'col_error[1-9]' && plan_speeds errors errors frequencies.dat -
    have_modes && several frequencies.dat || return 0
    needed=+f
    plan_speeds frequencies frequencies frequencies.dat -
    [ "$n" -gt 1 ] || return 0
    for mode in $(ask facts frequencies.dat | tr ' ' '\n' | sed -n 's/^col_f\([0-9][0-9]*\)$/\1/p'); do
        needed=f$mode
        add "frequency_${mode}_by_speed" frequency_by_speed frequencies.dat '' "$mode"
    done
}

# All modes on a page for each speed, and every one alone. Where a linkage is no plain chain of links the program places what stands
# still, blocks and springs.
plan_modes() {
    if [ $linkage != four_bar ] || grep -q '^\(SPRING\|DAMPER\) ' echo.deck 2> /dev/null; then
        if [ ! -f shape_pins.dat ]; then
            remark 'blocks, springs and joints of modes need shape_pins.dat, which REPORT shapes writes'
        else
            can_place && settings="$settings; is_placed = 1"
        fi
    fi
    [ -n "${animate-}" ] || [ "$(ask 'distinct mode crank' shapes.dat | wc -l)" -eq 1 ] || plan_speeds modes modes shapes.dat -
    ask 'distinct mode crank speed' shapes.dat | named | while read -r mode _ crank crank_name speed speed_name; do
        add "mode_${mode}_crank_${crank_name}_speed_$speed_name" "${animate:-mode_shape}" shapes.dat "$speed $crank $mode"
    done
}

# no_four_bar: the log says how the program places such a linkage; without a log, some tables are those of its links or drives.
no_four_bar() {
    grep -q '^placed: ' run.log 2> /dev/null && return 0
    for table in kinematics.dat:link drive.dat:drive reactions.dat:pin linkage.dat:part motion.dat:position1; do
        [ -f "${table%:*}" ] && ask facts "${table%:*}" | grep -q "; col_${table#*:} = " && return 0
    done
    return 1
}

# cycle_table: a table of such a linkage with its positions.
cycle_table() {
    for table in pins.dat kinematics.dat drives.dat drive.dat reactions.dat points.dat lagrange.dat balance.dat bearings.dat frame.dat friction.dat coordinates.dat; do
        if [ -f $table ]; then
            echo $table
            return
        fi
    done
}

# plan_drive_locus: drive.dat is the older name of a table of drives, and of four-bars another one.
plan_drive_locus() {
    drives=drives.dat
    [ -f $drives ] || [ $linkage = four_bar ] || drives=drive.dat
    have sizing.dat && have $drives && add drive_locus drive_locus sizing.dat '' $drives
}

# A linkage that is no four-bar. A structure has one position: nothing is drawn over it.
plan_cycle() {
    needed=crank
    if [ -n "$cycle" ] && have "$cycle" && several "$cycle" && can_place; then
        add linkage_positions linkage_positions "$in_time$cycle"
        [ "${format:-png}" = png ] && can_animate && add linkage animate_cycle "$in_time$cycle"
    fi
    needed=
    # Places of a slider have no directions, and by a law a force comes to one of them more than once.
    if [ -n "$cycle" ] && [ -z "$over" ] && is_angle "$cycle"; then
        needed='shaking_x shaking_y'
        shaking=shaking.dat
        [ ! -f balance.dat ] || shaking=balance.dat
        have "$shaking" && several "$shaking" && plan_speeds shaking_force shaking_force "$shaking" shaking_x,shaking_y
        needed=
        # Where only the shaking force is balanced the remarks of the table say all.
        [ ! -f balance.dat ] || ! grep -q '^# rms over a turn' balance.dat || plan_balance balance.dat
    fi
}

plan_balance() { ! several "$1" || plan_speeds balance balance "$1" shaking_x,shaking_y,shaking_moment,torque,balanced_moment,balanced_torque; }

# is_angle TABLE: its positions are angles.
is_angle() { ask facts "$1" | grep -q "unit_crank = 'deg'"; }

# Angles always; what stands still has no curve worth drawing.
plan_kinematics() {
    several kinematics.dat || return 0
    for of in angles:theta velocities:omega accelerations:alpha; do
        needed="${of#*:}3 ${of#*:}4"
        case $of in
            angles*) needed="$needed transmission_angle" ;;
            *) complete "kinematics_${of%:*}" kinematics.dat && [ -n "$(ask "moving speed $needed" kinematics.dat)" ] || continue ;;
        esac
        add "kinematics_${of%:*}" kinematics "${over}kinematics.dat" '' "${of%:*}"
    done
    needed=
}

# The program can place the linkage anew.
can_place() {
    [ -n "$FLEXMECH" ] && [ -f echo.deck ] && return 0
    remark_once 'drawing a linkage needs echo.deck and the program flexmech (FLEXMECH=PATH names it)'
    return 1
}

# several TABLE [COLUMN]: it has more positions, or values of this column, than one.
several() { [ "$(ask "distinct ${2-crank}" "$1" | wc -l)" -gt 1 ]; }

# What this gnuplot can write.
terminals() { LC_ALL=C.UTF-8 gnuplot -e 'set print "-"; print GPVAL_TERMINALS'; }

# An animation is made of pictures that pngcairo draws.
can_animate() {
    case " $(terminals) " in
        *' gif '*' pngcairo '* | *' pngcairo '*' gif '*) ;;
        *) return 1 ;;
    esac
}

# The shaking force is drawn once, with counterweights if they are known.
plan_four_bar() {
    balance=
    have balance.dat && balance=balance.dat
    if have points.dat; then
        if ! several points.dat; then
            remark 'paths of points need several positions'
        elif can_place; then
            needed='x y'
            # The path of a mass centre is that of even positions.
            add coupler_curve coupler_curve points.dat "0 $(telling_crank points.dat)" "$([ -n "$over" ] || echo "$balance")"
            needed=crank
            [ "${format:-png}" = png ] && can_animate && add linkage animate_linkage points.dat '' points.dat
            needed=
        fi
    fi
    [ -z "$balance" ] || plan_balance "${over}balance.dat"
    if [ -z "$over" ] && { [ -n "$balance" ] || have reactions.dat; }; then
        needed='shaking_x shaking_y'
        several "${balance:-reactions.dat}" && plan_speeds shaking_force shaking_force "${balance:-reactions.dat}" shaking_x,shaking_y
        needed=
    fi
}

# The elastic response. Its strains at a gauge are drawn of all speeds too, if these are few.
plan_response() {
    needed='axial_strain bending_strain stress'
    if have strains.dat && several strains.dat speed && [ "$(ask 'distinct speed' strains.dat | wc -l)" -le 8 ]; then
        for gauge in $(ask 'distinct gauge' strains.dat); do
            add "strains_${gauge}_by_speed" gauge strains.dat '' "$gauge"
        done
    fi
    needed=
    intervals=
    [ -f intervals.dat ] && intervals=intervals.dat
    if [ -f stability.dat ] && have stability.dat && several stability.dat speed; then
        add growth growth stability.dat '' "$intervals"
    elif [ -n "$intervals" ] && ask facts intervals.dat | grep -q col_largest_growth && have intervals.dat; then
        add growth growth '' '' "$intervals"
    fi
}

# Modes swing; a linkage turns, and moves as its motor makes it.
plan_animations() {
    can_animate || fail 'this gnuplot lacks the terminal pngcairo or gif, which animations need'
    have shapes.dat && animate=animate_mode plan_modes
    plan_table
    needed=crank
    if [ $linkage != four_bar ]; then
        if [ -n "$cycle" ] && have "$cycle" && several "$cycle" && can_place; then add linkage animate_cycle "$in_time$cycle"; fi
        return
    fi
    points=
    have points.dat && points=points.dat
    have kinematics.dat || return
    if ! several kinematics.dat; then
        remark 'a linkage is animated only if kinematics.dat has more than one position'
        return
    fi
    can_place || return
    add linkage animate_linkage kinematics.dat '' "$points"
    needed=
    have motion.dat && add motion animate_motion motion.dat '' "$points"
}

# A deck with VARY: its rows belong to many mechanisms, and only frequencies and summaries are drawn, against what was varied.
varied=
for table in *.dat; do
    [ -z "$varied" ] && [ -f "$table" ] && varied=$(ask varied "$table")
done

# A drive with a law: its tables are over time.
over=
for table in *.dat; do
    if [ -z "$varied" ] && [ -f "$table" ] && ask facts "$table" | grep -q 'columns = .time  *speed  *crank '; then
        put_over_time "$table"
        over=$new/over_time/
    fi
done
# An elastic motion by a law has the time behind the speed: it is one motion, whose speeds are not told apart.
for table in transient.dat gauges.dat; do
    if [ -z "$varied" ] && grep -qs '^# crank: by the law ' "$table"; then
        mkdir -p "$new/over_time"
        awk '!/^#/ && NF > 0 { $1 = 0 } 1' "$table" > "$new/over_time/$table"
        over=$new/over_time/
    fi
done
if [ -n "$over" ]; then
    law=$(sed -n "s/^DRIVE .* law=\([^ ]*\).*/\1/p" echo.deck 2> /dev/null | awk '!told[$0]++' | paste -s -d, - | sed 's/,/, /g' |
        awk "$quoting"'NR == 1 && $0 != "" { print quoted($0) }')
    settings="$settings; law_name = ${law:-\"\"}"
fi
# Where several drives have laws, the linkage is where it is at instants.
in_time=
if [ -n "$over" ] && [ "$(grep -ci '^DRIVE .* law=' echo.deck 2> /dev/null)" -gt 1 ]; then
    in_time=$over
    settings="$settings; laws_in_time = 1"
fi

# Where the linkage is, of several ranges; a cycle of more than a turn.
its_range=$(sed -n -e 's/^range of the [a-z ]*: \([^ ]*\) to \([^ ]*\) .*/; home_low = \1; home_high = \2/p' \
    -e 's/^cycle: \([^ ]*\) deg .*/; cycle = \1/p' run.log 2> /dev/null | tr -d '\n')
settings="$settings$its_range"

case $format in
    svg) terminal=svg ;;
    pdf) terminal=pdfcairo ;;
    *) terminal= ;;
esac
case " $(terminals) " in
    *" $terminal "*) ;;
    *) [ -z "$terminal" ] || fail "this gnuplot cannot write $format: it lacks the terminal $terminal" ;;
esac

: > "$new/plan"
linkage=four_bar
cycle=
if no_four_bar; then
    linkage=other
    cycle=$(cycle_table)
    settings="$settings; is_cycle = 1"
    [ ! -f echo.deck ] || grep -qi '^DRIVE ' echo.deck || { linkage=structure; settings="$settings; is_structure = 1"; }
fi
if [ -n "$varied" ]; then
    [ $figures = figures ] || fail "$outdir has nothing to animate: its tables are those of a deck with VARY"
    [ -f frequencies.dat ] || [ -f summary.dat ] ||
        fail "$outdir has nothing to draw: of a deck with VARY only frequencies.dat and summary.dat are drawn (REPORT frequencies, summary)"
    if have frequencies.dat && have_modes; then
        needed=+f
        for parameter in $varied; do add "frequencies_by_$parameter" varied frequencies.dat '' "$parameter"; done
        needed=
    fi
    if have summary.dat; then
        for parameter in $varied; do add "summary_by_$parameter" summary summary.dat '' "$parameter"; done
    fi
elif [ $figures = animations ]; then
    plan_animations
else
    [ $linkage = four_bar ] && [ -z "$over" ] && have inertia.dat && plan_mechanism
    have mesh.dat && add finite_element_model finite_element_model mesh.dat "0 $(telling_crank mesh.dat)"
    have frequencies.dat && plan_frequencies
    needed=
    have shapes.dat && plan_modes
    if [ $linkage != four_bar ]; then
        plan_cycle
    else
        have kinematics.dat && plan_kinematics
        plan_four_bar
    fi
    plan_drive_locus
    plan_response
    plan_table
fi
# What tables have instead of numbers and names, and the figures that it costs.
if [ -f "$new/refused" ]; then
    awk '{ figure = $1; sub(/^[^ ]* /, "") }
        !($0 in figures) { fault[++n] = $0 }
        { figures[$0] = figures[$0] " " figure }
        END { for (i = 1; i <= n; i++) print fault[i] "; not drawn:" figures[fault[i]] }' "$new/refused" |
        while IFS= read -r line; do remark "$outdir/$line"; done
    [ -s "$new/plan" ] || fail "$outdir/$figures is left as it was"
fi
if [ ! -s "$new/plan" ]; then
    ! ls ./*.csv > /dev/null 2>&1 || ls ./*.dat > /dev/null 2>&1 ||
        fail "$outdir has tables as comma-separated values only; figures are drawn from plain ones (without --format csv-only)"
    [ $figures = figures ] ||
        fail "$outdir has nothing to animate: animations need REPORT kinematics, motion or shapes"
    [ $linkage != structure ] || fail "$outdir has nothing to draw: of a structure modes are drawn (REPORT shapes)"
    fail "$outdir has no table that a figure can be drawn from${only:+ of ${only#,}}; curves need several positions"
fi

# The plan becomes calls of the scripts, dealt out to two runs of gnuplot (starting one for each figure takes longer).
: > "$new/draw0"
: > "$new/draw1"
DECK=${PWD##*/} awk -v new="$new" -v animated="${figures#figures}" "$quoting"'
    NR == FNR {
        if ($1 != ENVIRON["DECK"] || animated) next
        number[$2] = $3
        file[$2] = $4
        for (i = 5; i <= NF; i++) remark[$2] = remark[$2] (i > 5 ? " " : "") $i
        next
    }
    {
        n = split($0, part, "|")
        name = part[1]
        if (!(name in file)) file[name] = name
        # The figures of several speeds are cells of one page, see style.gp.
        cells = split(part[4], asked, ";")
        calls_of = ""
        for (pass = cells > 1 ? 1 : 2; pass <= 2; pass++) for (cell = 1; cell == 1 || cell <= cells; cell++) {
            if (cells > 1) calls_of = calls_of "cells = " cells "; cell = " cell "; cell_pass = " pass "; "
            calls_of = calls_of "call " quoted(ENVIRON["PLOTS"] "/figure.gp") " " quoted(part[3]) " " quoted(new "/" file[name]) " " quoted(part[2]) \
                " " quoted(asked[cell])
            for (i = 5; i <= n; i++) calls_of = calls_of " " quoted(part[i])
            calls_of = calls_of " " quoted(number[name]) " " quoted(remark[name]) "; "
        }
        run = FNR % 2
        print "set print " quoted(new "/at" run) "; print " ++calls[run] "; set print; " calls_of > (new "/draw" run)
        print file[name] > (new "/names" run)
    }' "$PLOTS/thesis_figures.txt" "$new/plan" || fail 'awk failed'

# draw_all RUN SETTINGS: the calls of a run. Where one fails gnuplot ends, and begins again behind it.
# The scripts are UTF-8; in the C locale gnuplot warns about every degree sign. `timeout 0` passes a signal on to all that gnuplot runs.
draw_all() {
    trap 'kill $!; wait; exit 1' TERM
    exec 8<&-
    done_calls=0
    while
        tail -n +$((done_calls + 1)) "$new/draw$1" | LC_ALL=C.UTF-8 timeout 0 gnuplot -e "$2" - 2>> "$new/told$1" &
        ! wait $!
    do
        failed_call=$(cat "$new/at$1" 2> /dev/null) && [ "$failed_call" -gt $done_calls ] || return 1
        done_calls=$failed_call
        sed -n "${failed_call}p" "$new/names$1" >> "$new/undrawn$1"
    done
}
drawing=yes
draw_all 0 "$settings; fallback_told = 1" &
first=$!
draw_all 1 "$settings" &
wait $!
second_status=$?
wait "$first"
first_status=$?
drawing=
# It counts the pictures of an animation on standard error.
sed '/^[0-9]* frames in animation sequence$/d' "$new/told0" "$new/told1" >&2
sort "$new"/names? > "$new/sorted"
cat "$new"/undrawn? 2> /dev/null | sort > "$new/undrawn"
[ $first_status -eq 0 ] && [ $second_status -eq 0 ] && ! cmp -s "$new/sorted" "$new/undrawn" ||
    fail "gnuplot failed: $outdir/$figures is left as it was"

overlay=0
IFS=$newline
for one in $overlays; do
    IFS=$IFS_before
    overlay=$((overlay + 1))
    grep -qx $overlay "$new/overlaid" 2> /dev/null ||
        fail "$(typed overlay)$one: no figure of $outdir has these axes; expected headings and units as in its tables, such as crank [deg] and torque [N.m]" 2
done
IFS=$IFS_before

# Two runs into one folder: one after the other from here on.
exec 9< . && flock 9 2> /dev/null
mkdir -p $figures || fail "cannot write into $outdir/$figures"
if [ -f $figures/drawn.txt ]; then
    while IFS= read -r name; do
        case $name in
            '' | '#'* | */*) continue ;;
            *".${format:-png}" | *.gif) [ -n "$only" ] || { [ "${name##*.}" = gif ] && [ "${format:-png}" != png ]; } || rm -f "$figures/$name" ;;
        esac
        [ ! -f "$figures/$name" ] || grep -qxF -e "${name%.*}" "$new/sorted" && [ "${name##*.}" = "${format:-png}" ] || printf '%s\n' "$name" >> "$new/kept"
    done < $figures/drawn.txt
fi
{
    echo '# Drawn by draw_figures.sh, which removes these files when it draws again in their format.'
    cat "$new/kept" 2> /dev/null
} > "$new/drawn.txt"
while IFS= read -r name; do
    ! grep -qxF -e "$name" "$new/undrawn" || continue
    drawn=
    for ending in png svg pdf gif; do
        [ -s "$new/$name.$ending" ] || continue
        drawn=$name.$ending
        printf '%s\n' "$drawn" >> "$new/drawn.txt"
        printf '%s\n' "$drawn" >> "$new/drawn_now"
        mv -f "$new/$drawn" $figures/ || fail "cannot write into $outdir/$figures"
    done
    [ -n "$drawn" ] || printf '%s\n' "$name" >> "$new/undrawn"
done < "$new/sorted"
sort -u "$new/drawn.txt" > $figures/drawn.txt || fail "cannot write into $outdir/$figures"
sort "$new/drawn_now" 2> /dev/null | while IFS= read -r name; do
    printf '%s/%s/%s\n' "$outdir" $figures "$name"
done
[ ! -s "$new/undrawn" ] || fail "not drawn, since gnuplot failed:$(sort -u "$new/undrawn" | while IFS= read -r name; do printf ' %s/%s/%s' "$outdir" $figures "$name"; done)"
[ ! -f "$new/refused" ] || exit 1
