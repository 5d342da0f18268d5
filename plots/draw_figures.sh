#!/bin/sh
# Draws every figure that the tables of one deck allow, into the folder `figures` beside them (the linkage that draws the
# paths of points, as an animated GIF too), or animates all that moves in them, into the folder `animations`. This is the
# command flexmech-plot; `draw_figures.sh --help` lists its options.
# A figure of the thesis gets its number (thesis_figures.txt). The figures of the last run stay until new ones are
# drawn; then they go, and files that this script did not draw stay. Prints a line a figure.

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
  --errors         draw the estimated errors of the frequencies too
  --format FORMAT  png, svg or pdf; default: png
  --size SIZE      of every figure: WIDTHxHEIGHT in pixels, such as 1200x800, or in millimetres,
                   such as 160x100mm; default: 1600 pixels wide, as high as it needs to be
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
wanted=
options=
ended=
while [ $# -gt 0 ]; do
    option=${1%%=*}
    case $option in
        --format | --size)
            case $1 in
                *=*) value=${1#*=} ;;
                *)
                    [ $# -gt 1 ] || misused "$option takes a value"
                    value=$2
                    shift ;;
            esac
            [ -n "$value" ] || misused "$option takes a value"
            [ $option = --format ] && format=$value || size=$value
            options="$options $option $value" ;;
        --animate | --errors | --no-titles | --help | --version)
            [ "$option" = "$1" ] || misused "$option takes no value: $1"
            case $option in
                --animate) figures=animations ;;
                --errors) errors=yes ;;
                --no-titles) titles=no ;;
                *) wanted=$option ;;
            esac
            options="$options $option" ;;
        --)
            ended=yes
            shift
            break ;;
        -?*) misused "unknown option $1" ;;
        *) break ;;
    esac
    shift
done
# Typed at make, options have other names.
[ "$command" = make ] && format_option=FORMAT= && size_option=SIZE= || { format_option='--format '; size_option='--size '; }
for folder in "$@"; do
    case $ended${folder%%=*} in
        --animate | --errors | --no-titles | --format | --size | --help | --version)
            misused "options stand before the folder: $folder" ;;
    esac
done
case $format in
    '' | png | svg | pdf) ;;
    *) misused "$format_option$format: png, svg or pdf" ;;
esac
settings="figure_format = '$format'; figure_titles = $([ $titles = no ]; echo $?); figure_width = 0"
if [ -n "$size" ]; then
    set_size=$(size_words "$size")
    [ -n "$set_size" ] ||
        misused "$size_option$size: WIDTHxHEIGHT of 150 to 10000 pixels or 40 to 2000 mm each, such as 1200x800 or 160x100mm"
    settings="$settings; $(echo "$set_size" | awk '{ printf "figure_width = %d; figure_height = %d; figure_unit = \"%s\"", $1, $2, $3 }')"
fi
if [ $figures = animations ]; then
    [ -z "$format$size" ] && [ $errors = no ] ||
        misused '--animate takes no --format, --size or --errors: an animation is a GIF of fixed size'
fi
if [ "$wanted" = --help ]; then
    help
    exit
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
[ $# -gt 0 ] || misused 'the folder with the tables of a deck is missing'
if [ $# -gt 1 ]; then
    status=0
    trap 'kill ${!-} 2> /dev/null; wait; exit 130' INT
    trap 'kill ${!-} 2> /dev/null; wait; exit 143' TERM HUP
    for folder in "$@"; do
        # The options are plain words. A shell obeys a signal while it waits, not while it runs something.
        sh "$PLOTS/draw_figures.sh" $options -- "$folder" &
        wait $! || status=1
    done
    exit $status
fi
outdir=${1%/}
# No name for `cd` that begins with a dash, or that CDPATH leads elsewhere.
case $1 in /*) folder=$1 ;; *) folder=${1:+./$1} ;; esac
[ ! -f "$folder" ] || fail "$outdir is a file: name the folder with the tables of a deck, such as outputs/mechanism1" 2
[ -d "$folder" ] || fail "no folder $outdir" 2
command -v gnuplot > /dev/null || fail 'gnuplot is not installed'

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

# ask WANT TABLE: see tables.awk
ask() { awk -v want="$1" -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$2"; }

# A text as gnuplot reads it, for awk.
quoting=$(cat "$PLOTS/quoted.awk")

# have TABLE [COLUMN]: it is there and has rows.
have() {
    [ -f "$1" ] || return 1
    [ -n "$(ask "distinct ${2-crank}" "$1")" ] && return 0
    remark "$outdir/$1 has no row that could be computed"
    return 1
}

# drawn_from SCRIPT [WHAT]: the columns of its table that a script draws, where it does not draw all, or `columns=` of a REPORT card may
# leave them out; with a + those without which it draws the others. f stands for f1, f2, …
drawn_from() {
    case $1 in
        kinematics.gp)
            case $2 in
                angles) echo theta3 theta4 transmission_angle ;;
                velocities) echo omega3 omega4 ;;
                *) echo alpha3 alpha4 ;;
            esac ;;
        link_motion.gp) echo theta omega alpha ;;
        pin_motion.gp) echo x y vx vy ax ay ;;
        point_rates.gp) echo vx vy ax ay ;;
        coupler_curve.gp) echo x y ;;
        reactions.gp) echo O2x O2y A2x A2y A3x A3y B3x B3y B4x B4y O4x O4y torque ;;
        forces.gp | animate_forces.gp) echo O2x O2y A3x A3y B3x B3y O4x O4y shaking_x shaking_y ;;
        shaking_force.gp) echo shaking_x shaking_y ;;
        joint_forces.gp) echo fx fy ;;
        bearings.gp) echo fx fy axial transverse magnitude ;;
        lagrange.gp) echo +M +V +gravity +load torque kinetic potential ;;
        displacements.gp | pin_displacements.gp | deviation.gp) echo ux uy ;;
        deformed_linkage.gp | animate_response.gp) echo ux uy rotation ;;
        strains.gp | gauge_by_speed.gp) echo axial_strain bending_strain stress ;;
        drive.gp) echo rigid linear quadratic total power ;;
        largest_strain.gp) echo strain ;;
        frequencies.gp | varied.gp) echo +f ;;
        frequency_by_speed.gp) echo "f$2" ;;
        errors.gp) echo +error ;;
        linkage_positions.gp | animate_cycle.gp | animate_linkage.gp) echo crank ;;
    esac
}

# complete FIGURE SCRIPT TABLE [WHAT]: the table has what the script draws; what it lacks is told once.
complete() {
    needed=$(drawn_from "$2" "${4-}")
    [ -n "$needed" ] && [ -n "$3" ] || return 0
    its_columns=" $(ask facts "$3" | tr ';' '\n' | sed -n 's/^ col_\([^ ]*\) = .*/\1/p' | tr '\n' ' ')"
    lacking=
    for column in $needed; do
        case $column$its_columns in +* | *" $column "*) ;; *) lacking="$lacking $column" ;; esac
    done
    [ -n "$lacking" ] || return 0
    lacking="$1 is not drawn: $outdir/${3##*/} has no column$lacking (columns= of its REPORT card)"
    grep -qxF -e "$lacking" "$new/lacking" 2> /dev/null || remark "$lacking"
    printf '%s\n' "$lacking" >> "$new/lacking"
    return 1
}

# sound FIGURE SCRIPT TABLE [ARGUMENT…]: there are numbers and names in the tables where the figure needs them; what else there is, is
# told at the end.
sound() {
    figure=$1
    needed=" - $(drawn_from "$2" "${4-}" | tr -d +) "
    shift 2
    for table in "$@"; do
        table=${table##*/}
        case $table in *.dat) [ -f "$table" ] || continue ;; *) continue ;; esac
        [ -f "$new/wrong/$table" ] || ask wrong "$table" > "$new/wrong/$table"
        while read -r column fault; do
            case $needed in
                ' -  ' | *" $column "* | *" ${column%%[0-9]*} "*)
                    printf '%s %s, %s\n' "$figure" "$table" "$fault" >> "$new/refused"
                    return 1 ;;
            esac
        done < "$new/wrong/$table"
        needed=' -  '               # of the first table some columns, of others all
    done
}

# add FIGURE SCRIPT TABLE [ARGUMENT…]
add() {
    sound "$@" && complete "$1" "$2" "$3" "${4-}" || return 0
    (IFS='|'; printf '%s\n' "$*") >> "$new/plan"
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
    add mechanism mechanism.gp inertia.dat "$(telling_crank inertia.dat)" "$(greatest_speed inertia.dat)" "$mesh"
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

# plan_speeds NAME TABLE [COLUMNS [SCRIPT [TABLE]]]: NAME.gp, or SCRIPT, draws one speed of the table, unless all these columns are zero.
plan_speeds() {
    speeds=$(ask 'distinct speed' "$2")
    n=$(printf '%s\n' "$speeds" | wc -l)
    complete "$1" "${4-$1.gp}" "$2" || return 0
    speed_names=$(printf '%s\n' "$speeds" | named)
    [ -z "${3-}" ] || speeds=$(ask "moving $3" "$2")
    for speed in $speeds; do
        name=$1
        [ "$n" -eq 1 ] || name=$1_speed_$(printf '%s\n' "$speed_names" | awk -v speed="$speed" '$1 == speed { print $2; exit }')
        add "$name" "${4-$1.gp}" "$2" "$speed" ${5:+"$5"}
    done
}

plan_frequencies() {
    [ -z "$structure" ] || return 0
    [ $errors = yes ] && ask facts frequencies.dat | grep -q 'col_error[1-9]' && plan_speeds errors frequencies.dat
    have_modes || return 0
    plan_speeds frequencies frequencies.dat
    [ "$n" -gt 1 ] || return 0
    for mode in $(ask facts frequencies.dat | tr ' ' '\n' | sed -n 's/^col_f\([0-9][0-9]*\)$/\1/p'); do
        add "frequency_${mode}_by_speed" frequency_by_speed.gp frequencies.dat "$mode"
    done
}

# All modes on a page for each speed, and every one alone. Where a linkage is no plain chain of links the program places what stands
# still, blocks and springs.
plan_modes() {
    if [ $other = yes ] || grep -q '^\(SPRING\|DAMPER\) ' echo.deck 2> /dev/null; then
        can_place && settings="$settings; is_placed = 1"
    fi
    [ -n "${animate-}" ] || [ "$(ask 'distinct mode crank' shapes.dat | wc -l)" -eq 1 ] || plan_speeds modes shapes.dat
    ask 'distinct mode crank speed' shapes.dat | named | while read -r mode _ crank crank_name speed speed_name; do
        add "mode_${mode}_crank_${crank_name}_speed_$speed_name" "${animate:-mode_shape.gp}" shapes.dat "$mode" "$crank" "$speed"
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
    for table in pins.dat kinematics.dat drives.dat drive.dat reactions.dat points.dat lagrange.dat balance.dat bearings.dat frame.dat friction.dat; do
        if [ -f $table ]; then
            echo $table
            return
        fi
    done
}

# plan_drives: what drives rigid links; drive.dat is the older name of their table.
plan_drives() {
    drives=
    for table in drive.dat drives.dat; do
        [ -f "$table" ] && ask facts "$table" | grep -q '; col_drive = ' && drives=$table
    done
    shaking=
    [ -f shaking.dat ] && shaking=${over}shaking.dat
    [ -n "$drives" ] && have "$drives" || return 0
    plan_speeds drive_forces "$over$drives" '' drive_forces.gp "$shaking"
    have sizing.dat && [ -z "$over" ] && add drive_locus drive_locus.gp sizing.dat "$drives"
}

# A linkage that is no four-bar. A structure has one position: nothing is drawn over it.
plan_cycle() {
    if [ -n "$cycle" ] && have "$cycle" && several "$cycle" && can_place; then
        add linkage_positions linkage_positions.gp "$cycle"
        [ "${format:-png}" = png ] && can_animate && add linkage animate_cycle.gp "$cycle"
    fi
    have kinematics.dat && plan_speeds link_motion "${over}kinematics.dat"
    have pins.dat && plan_speeds pin_motion "${over}pins.dat"
    have points.dat && plan_speeds point_rates "${over}points.dat" 'vx vy ax ay'
    [ -z "$structure" ] && have reactions.dat && plan_speeds joint_forces "${over}reactions.dat" 'fx fy'
    plan_bearings
    plan_drives
    # Places of a slider have no directions, and by a law a force comes to one of them more than once.
    if [ -n "$cycle" ] && [ -z "$over" ] && ask facts "$cycle" | grep -q "unit_crank = 'deg'"; then
        [ -f balance.dat ] && shaking=balance.dat
        [ -n "$shaking" ] && have "$shaking" && plan_speeds shaking_force "$shaking" 'shaking_x shaking_y'
        # Where only the shaking force is balanced the remarks of the table say all.
        [ ! -f balance.dat ] || ! grep -q '^# rms over a turn' balance.dat ||
            plan_speeds balance balance.dat 'shaking_x shaking_y shaking_moment torque balanced_moment balanced_torque'
    fi
    have harmonics.dat && plan_speeds harmonics harmonics.dat largest
    have lagrange.dat && plan_speeds lagrange "${over}lagrange.dat"
    plan_equilibrium
    have linkage.dat && add limits limits.gp linkage.dat
    have motion.dat time && add motion motion.gp motion.dat
}

# Of any linkage: friction; loci of the forces in its joints, and of that on the frame beside the shaking force. Places of a slider
# have no directions, and figures of a law are over time.
plan_bearings() {
    if have friction.dat; then
        plan_speeds friction "${over}friction.dat" lost friction.gp "$([ -n "$over" ] || ls holding.dat 2> /dev/null)"
    fi
    [ -z "$over" ] || return 0
    have bearings.dat && several bearings.dat && plan_speeds bearings bearings.dat magnitude
    if have frame.dat && several frame.dat && ask facts frame.dat | grep -q "unit_crank = 'deg'"; then
        plan_speeds frame_force frame.dat 'frame_x frame_y' shaking_force.gp
    fi
}

# Of any linkage: where it rests, on its potential.
plan_equilibrium() { [ ! -f equilibrium.dat ] || ! have potential.dat || add equilibrium equilibrium.gp potential.dat equilibrium.dat; }

# Angles always; what stands still has no curve worth drawing.
plan_kinematics() {
    add kinematics_angles kinematics.gp "${over}kinematics.dat" angles
    [ "$(ask 'range omega3 omega4' kinematics.dat)" = '0 0' ] ||
        add kinematics_velocities kinematics.gp "${over}kinematics.dat" velocities
    [ "$(ask 'range alpha3 alpha4' kinematics.dat)" = '0 0' ] ||
        add kinematics_accelerations kinematics.gp "${over}kinematics.dat" accelerations
}

# The program can place the linkage anew.
can_place() {
    [ -n "$FLEXMECH" ] && [ -f echo.deck ] && return 0
    remark 'drawing a linkage needs echo.deck and the program flexmech (FLEXMECH=PATH names it)'
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

# plan_forces SCRIPT: at the speeds at which there is a force at all.
plan_forces() { plan_speeds forces reactions.dat 'O2x O2y A3x A3y B3x B3y O4x O4y shaking_x shaking_y' "$1"; }

# The shaking force is drawn once, with counterweights if they are known.
plan_rigid_dynamics() {
    balance=
    have balance.dat && balance=balance.dat
    if have points.dat; then
        plan_speeds point_rates "${over}points.dat" 'vx vy ax ay'
        if ! several points.dat; then
            remark 'paths of points need several positions'
        elif can_place; then
            # The path of a mass centre is that of even positions.
            add coupler_curve coupler_curve.gp points.dat "$(telling_crank points.dat)" "$([ -n "$over" ] || echo "$balance")"
            [ "${format:-png}" = png ] && can_animate && add linkage animate_linkage.gp points.dat points.dat
        fi
    fi
    have linkage.dat && can_place && add special_positions special_positions.gp linkage.dat
    have reactions.dat &&
        plan_speeds reactions "${over}reactions.dat" 'O2x O2y A2x A2y A3x A3y B3x B3y B4x B4y O4x O4y torque'
    if [ -n "$over" ]; then
        [ -z "$balance" ] ||
            plan_speeds balance "${over}balance.dat" 'shaking_x shaking_y shaking_moment torque balanced_moment balanced_torque'
        plan_drives
        have lagrange.dat && plan_speeds lagrange "${over}lagrange.dat"
        have pins.dat && plan_speeds pin_motion "${over}pins.dat"
        return
    fi
    have reactions.dat && can_place && plan_forces forces.gp
    [ -n "$balance" ] || ! have reactions.dat || plan_speeds shaking_force reactions.dat 'shaking_x shaking_y'
    if [ -n "$balance" ]; then
        plan_speeds shaking_force balance.dat 'shaking_x shaking_y'
        plan_speeds balance balance.dat 'shaking_x shaking_y shaking_moment torque balanced_moment balanced_torque'
    fi
    plan_bearings
    plan_drives
    plan_equilibrium
    have harmonics.dat && plan_speeds harmonics harmonics.dat largest
    have lagrange.dat && plan_speeds lagrange lagrange.dat
    have motion.dat && add motion motion.gp motion.dat
    have pins.dat && plan_speeds pin_motion pins.dat
}

# The elastic response. Its strains at a gauge are drawn of all speeds too, if these are few; what is drawn against the speed needs
# several.
plan_response() {
    if have response.dat; then
        plan_speeds displacements response.dat 'ux uy'
        plan_speeds pin_displacements response.dat 'ux uy'
        if [ $other = no ] && several response.dat && can_place; then
            [ -z "$(ask points response.dat)" ] || plan_speeds deviation response.dat 'ux uy'
            plan_speeds deformed_linkage response.dat 'ux uy'
        fi
    fi
    if have strains.dat; then
        plan_speeds strains strains.dat 'axial_strain bending_strain stress'
        if [ "$n" -gt 1 ] && [ "$n" -le 8 ]; then
            for gauge in $(ask 'names gauge' strains.dat); do
                add "strains_${gauge}_by_speed" gauge_by_speed.gp strains.dat "$gauge"
            done
        fi
    fi
    have transient.dat && plan_speeds transient transient.dat 'ux uy' displacement_history.gp
    have gauges.dat && plan_speeds transient_strains gauges.dat 'axial_strain bending_strain stress' strain_history.gp
    [ "$drives" != drive.dat ] && have drive.dat && plan_speeds drive drive.dat 'rigid linear quadratic'
    have torque.dat && plan_speeds torque torque.dat 'rigid linear quadratic' drive.gp
    frequencies=
    [ -f frequencies.dat ] && frequencies=frequencies.dat
    have peaks.dat speed && several peaks.dat speed && add largest_strain largest_strain.gp peaks.dat "$frequencies"
    critical=
    [ -f critical.dat ] && critical=critical.dat
    intervals=
    [ -f intervals.dat ] && intervals=intervals.dat
    have campbell.dat speed && several campbell.dat speed && add campbell campbell.gp campbell.dat "$critical" "$intervals"
    have validity.dat speed && several validity.dat speed && add validity validity.gp validity.dat
    have stability.dat speed && add multipliers multipliers.gp stability.dat
    if [ -f stability.dat ] && have stability.dat speed && several stability.dat speed; then
        add growth growth.gp stability.dat "$intervals"
    elif [ -n "$intervals" ] && ask facts intervals.dat | grep -q col_largest_growth && have intervals.dat from; then
        add growth growth.gp '' "$intervals"
    fi
}

# Modes swing; a linkage turns, and moves as its motor makes it.
plan_animations() {
    can_animate || fail 'this gnuplot lacks the terminal pngcairo or gif, which animations need'
    have shapes.dat && animate=animate_mode.gp plan_modes
    if [ $other = yes ]; then
        if [ -n "$cycle" ] && have "$cycle" && several "$cycle" && can_place; then add linkage animate_cycle.gp "$cycle"; fi
        if have motion.dat time && several motion.dat time && can_place; then add motion animate_linkage_motion.gp motion.dat; fi
        return
    fi
    if [ -z "$over" ] && have reactions.dat && [ "$(ask 'distinct crank' reactions.dat | wc -l)" -ge 12 ] && can_place; then
        plan_forces animate_forces.gp
    fi
    if have response.dat && [ "$(ask 'distinct crank' response.dat | wc -l)" -ge 12 ] && can_place; then
        plan_speeds deformed_linkage response.dat 'ux uy' animate_response.gp
    fi
    points=
    have points.dat && points=points.dat
    have kinematics.dat || return
    if ! several kinematics.dat; then
        remark 'a linkage is animated only if kinematics.dat has more than one position'
        return
    fi
    can_place || return
    add linkage animate_linkage.gp kinematics.dat "$points"
    have motion.dat && add motion animate_motion.gp motion.dat "$points"
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
if [ -n "$over" ]; then
    law=$(sed -n "s/^DRIVE .* law=\([^ ]*\).*/\1/p" echo.deck 2> /dev/null | awk "$quoting"'NR == 1 { print quoted($0) }')
    settings="$settings; law_name = ${law:-\"\"}"
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
other=no
drives=
cycle=
structure=
if no_four_bar; then
    other=yes
    cycle=$(cycle_table)
    settings="$settings; is_cycle = 1"
    [ ! -f echo.deck ] || grep -qi '^DRIVE ' echo.deck || structure=yes
    [ -z "$structure" ] || settings="$settings; is_structure = 1"
fi
if [ -n "$varied" ]; then
    [ $figures = figures ] || fail "$outdir has nothing to animate: its tables are those of a deck with VARY"
    [ -f frequencies.dat ] || [ -f summary.dat ] ||
        fail "$outdir has nothing to draw: of a deck with VARY only frequencies.dat and summary.dat are drawn (REPORT frequencies, summary)"
    if [ -f frequencies.dat ] && have frequencies.dat && have_modes; then
        for parameter in $varied; do
            add "frequencies_by_$parameter" varied.gp frequencies.dat "$parameter"
        done
    fi
    if [ -f summary.dat ] && have summary.dat rows; then
        for parameter in $varied; do
            add "summary_by_$parameter" summary.gp summary.dat "$parameter"
        done
    fi
elif [ $figures = animations ]; then
    plan_animations
else
    [ $other = no ] && [ -z "$over" ] && have inertia.dat && plan_mechanism
    have mesh.dat && add finite_element_model finite_element_model.gp mesh.dat "$(telling_crank mesh.dat)"
    have frequencies.dat && plan_frequencies
    have branches.dat && plan_speeds branches branches.dat
    have shapes.dat && plan_modes
    if [ $other = yes ]; then
        plan_cycle
    else
        have kinematics.dat && plan_kinematics
        plan_rigid_dynamics
    fi
    plan_response
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
    [ -z "$structure" ] || fail "$outdir has nothing to draw: of a structure modes are drawn (REPORT shapes)"
    fail "$outdir has no table that a figure can be drawn from"
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
        call = "call " quoted(ENVIRON["PLOTS"] "/" part[2]) " " quoted(part[3]) " " quoted(new "/" file[name])
        for (i = 4; i <= n; i++) call = call " " quoted(part[i])
        run = FNR % 2
        print "set print " quoted(new "/at" run) "; print " ++calls[run] "; set print; " call, quoted(number[name]), quoted(remark[name]) > (new "/draw" run)
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

# Two runs into one folder: one after the other from here on.
exec 9< . && flock 9 2> /dev/null
mkdir -p $figures || fail "cannot write into $outdir/$figures"
if [ -f $figures/drawn.txt ]; then
    while IFS= read -r name; do
        case $name in
            '' | '#'* | */*) ;;
            *) rm -f "$figures/$name" ;;
        esac
    done < $figures/drawn.txt
fi
echo '# Drawn by draw_figures.sh, which removes these files when it draws again.' > "$new/drawn.txt"
while IFS= read -r name; do
    ! grep -qxF -e "$name" "$new/undrawn" || continue
    drawn=
    for ending in png svg pdf gif; do
        [ -s "$new/$name.$ending" ] || continue
        drawn=$name.$ending
        printf '%s\n' "$drawn" >> "$new/drawn.txt"
        mv -f "$new/$drawn" $figures/ || fail "cannot write into $outdir/$figures"
    done
    [ -n "$drawn" ] || printf '%s\n' "$name" >> "$new/undrawn"
done < "$new/sorted"
cp "$new/drawn.txt" $figures/drawn.txt || fail "cannot write into $outdir/$figures"
sed -n "/^#/!p" $figures/drawn.txt | while IFS= read -r name; do
    printf '%s/%s/%s\n' "$outdir" $figures "$name"
done
[ ! -s "$new/undrawn" ] || fail "not drawn, since gnuplot failed:$(sort -u "$new/undrawn" | while IFS= read -r name; do printf ' %s/%s/%s' "$outdir" $figures "$name"; done)"
[ ! -f "$new/refused" ] || exit 1
