!> Loads of processes: the links, pins and tables that their cards name, and the reports that do not
!! take them.
module process_checks
  use body_checks, only: seek_link, seek_loaded_pin
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use kinds, only: wp
  use models, only: has_law, model_t, nature_of_positions
  use name_checks, only: link_ends, look_up, pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use named_coordinates, only: coordinate_number, find_named_coordinates, named_coordinate_t
  use natures, only: angle_nature, is_angular, length_nature, nature_t
  use process_cards, only: over_angle, over_drive, over_measure, over_slider, over_time, &
    over_travel, process_card_t, process_force, process_resistance
  use table_cards, only: number_table_t, read_table
  use text, only: same_word, to_string
  use tokens, only: token_texts
  use units, only: dimension_force, dimension_moment, dimension_time
  implicit none (type, external)
  private

  public :: find_processes

  real(wp), parameter :: degree = acos(-1.0_wp)/180.0_wp

  !> A table ends as it begins, and is over whole turns, to this share of its values.
  real(wp), parameter :: rounding = 1.0e-9_wp

contains

  !> Looks up names and reads tables of FORCE, TORQUE and LOAD cards.
  !!
  !! Errors: unknown names; a force on a ground pivot; a table over what it cannot be over; errors
  !! of `read_table`; a table of one row; one over whole turns that does not close; reports on
  !! links that bend, which do not take these loads.
  pure subroutine find_processes(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! has its links and pins; numbers and tables
                                                      !! of its processes are set

    type(name_index_t) :: links, ends, pins, grounds
    integer :: i

    links = new_name_index(token_texts(model%links%name))
    ends = new_name_index(token_texts(link_ends(model%links)))
    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%processes)
      associate (process => model%processes(i))
        if (process%on_link) then
          call seek_link(process%subject, links, ends, diagnostics, process%link)
        else
          call seek_loaded_pin(process%subject, pins, grounds, links, model, diagnostics)
        end if
        if (process%table_word%line > 0) call find_table(cards, model, links, pins, process, &
          diagnostics)
      end associate
    end do
    call refuse_reports(diagnostics, model)
    call warn_of_dampers(diagnostics, model)
  end subroutine find_processes

  !> Finds what a table is over, and reads it.
  pure subroutine find_table(cards, model, links, pins, process, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins
    type(process_card_t), intent(inout) :: process
    type(diagnostics_t), intent(inout) :: diagnostics

    type(number_table_t) :: table
    integer :: dimensions(4, 2)
    type(nature_t) :: nature
    logical :: fine, is_angle

    call find_variable(model, links, pins, process, diagnostics, fine, nature)
    if (.not. fine) return
    is_angle = is_angular(nature)
    dimensions(:, 1) = nature%value
    if (process%over == over_time) dimensions(:, 1) = dimension_time
    dimensions(:, 2) = merge(dimension_force, dimension_moment, process%kind == process_force)
    call read_table(cards, process%table_word, "position and load", dimensions, diagnostics, &
      table, fine)
    if (.not. fine) return
    associate (rows => size(table%values, 2), x => table%values(1, :), y => table%values(2, :))
      if (rows < 2) then
        call add_error(diagnostics, process%table_word, &
          "a load by a table needs two rows at least; this table has "//to_string(rows))
        return
      end if
      if (is_angle) then
        associate (turns => (x(rows) - x(1))/360.0_wp)
          process%is_periodic = nint(turns) > 0 .and. abs(turns - nint(turns)) <= rounding
        end associate
      end if
      if (process%is_periodic .and. abs(y(rows) - y(1)) > rounding*maxval(abs(y))) then
        call add_error(diagnostics, table%words(2, rows), "this table is over whole turns and "// &
          "does not close: its last value must be its first", table%words(2, 1), &
          "the first is here")
        return
      end if
      process%x = x*merge(degree, 1.0_wp, is_angle)
      process%y = y
      if (process%is_periodic) process%y(rows) = process%y(1)
    end associate
  end subroutine find_table

  !> What a table is over: the first drive without `over=`; the place of the block at a pin; of
  !! another pin, on which the force acts, its travel; the angle of a link; a coordinate with a
  !! name; the time.
  pure subroutine find_variable(model, links, pins, process, diagnostics, fine, nature)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins
    type(process_card_t), intent(inout) :: process
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: fine
    type(nature_t), intent(out) :: nature !! a length where it is none

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i

    fine = .true.
    process%over = over_drive
    nature = nature_of_positions(model)
    associate (word => process%over_word)
      if (word%line == 0) return
      nature = length_nature
      do i = 1, size(model%sliders)
        if (.not. same_word(model%sliders(i)%pin%text, word%text)) cycle
        process%over = over_slider
        process%number = i
        return
      end do
      if (process%kind == process_force .and. same_word(word%text, process%subject%text) .and. &
        .not. process%on_link) then
        process%over = over_travel
        return
      end if
      process%number = find_name(links, word%text)
      process%over = over_angle
      if (process%number > 0) then
        nature = angle_nature
        return
      end if
      call find_named_coordinates(model, named)
      process%number = coordinate_number(named, word%text)
      process%over = merge(over_measure, over_time, process%number > 0)
      if (process%number > 0) then
        nature = named(process%number)%nature
        return
      end if
      if (same_word(word%text, "time")) return
      fine = .false.
      if (find_name(pins, word%text) > 0) then
        call add_error(diagnostics, word, "no block slides at pin '"//word%text// &
          "'; a table is over the place of a block, the angle of a link, or the travel of the "// &
          "pin on which the force acts")
      else
        call look_up(word, links, "link, pin, measure or time", diagnostics, i)
      end if
    end associate
  end subroutine find_variable

  !> Refuses reports on links that bend. What the position determines of these loads acts on the
  !! axial forces of frequencies, but a force that turns with its link is no dead load: its change
  !! as the link vibrates has no potential, and would make the stiffness unsymmetric.
  pure subroutine refuse_reports(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, k

    if (has_errors(diagnostics)) return
    do k = 1, size(model%reports)
      do i = 1, size(model%processes)
        associate (process => model%processes(i), report => model%reports(k))
          if (process%over == over_time .and. (report%kind%name == "equilibrium" .or. &
            (report%kind%masses .or. report%kind%frequencies) .and. report%kind%name /= "motion" &
            .and. .not. has_law(model))) then
            call add_error(diagnostics, process%over_word, "positions have no time: a table "// &
              "over the time needs REPORT motion, or tables of a drive with a law, over TIME", &
              report%keyword, "this report has positions")
            exit
          else if (report%kind%response .and. .not. is_damper(process)) then
            call add_error(diagnostics, process%keyword, "REPORT "//trim(report%kind%name)// &
              " takes constant forces on pins and constant torques only", report%keyword, &
              "it is asked for here")
            exit
          else if (report%kind%frequencies .and. process%in_link_axes .and. &
            process%during == 0) then
            call add_error(diagnostics, process%axes_word, "REPORT "//trim(report%kind%name)// &
              " takes forces in global axes only: one that turns with its link as this "// &
              "vibrates is not conservative", report%keyword, "it is asked for here")
            exit
          end if
        end associate
      end do
    end do
  end subroutine refuse_reports

  !> Warns of loads that are nothing but damping where the elastic response is asked for.
  pure subroutine warn_of_dampers(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, report

    report = findloc(model%reports%kind%response, .true., dim=1)
    if (report == 0 .or. has_errors(diagnostics)) return
    do i = 1, size(model%processes)
      if (is_damper(model%processes(i))) call add_warning(diagnostics, &
        model%processes(i)%keyword, "REPORT "//trim(model%reports(report)%kind%name)// &
        " takes no notice of this LOAD, which is damping only; a DAMPER would act in it")
    end do
  end subroutine warn_of_dampers

  !> Whether a load is nothing but damping, which acts on rigid links only.
  pure function is_damper(process) result(is)
    type(process_card_t), intent(in) :: process
    logical :: is

    is = process%kind == process_resistance .and. abs(process%torque) <= 0.0_wp .and. &
      process%resisting <= 0.0_wp
  end function is_damper

end module process_checks
