!> `frequencies.dat` and `shapes.dat`.
module frequency_report
  use frequency_study, only: is_drawn
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_distributed, inertia_lumped, is_loaded, is_moving, &
    model_t, needs_loads, report_number
  use poses, only: pose_t
  use position_results, only: frequency_of
  use positions, only: positions_t
  use request_cards, only: report_shapes
  use sweeps, only: failure_at, has_result, sweep_t
  use tables, only: append_column, append_real_columns, column_t, integer_cell, integer_column, &
    name_cell, name_column, real_cells, real_column, table_t, write_failure, write_gap, &
    write_header, write_row
  use text, only: append_string, string_t, to_string
  use units, only: coherent_unit, dimension_length, dimension_mass, from_si, to_si, unit_t
  implicit none (type, external)
  private

  public :: write_frequencies, write_shapes, effects_notes

  !> Rows whose digits are worked out together, by all threads.
  integer, parameter :: rows_at_once = 1024

contains

  !> One row a position, one block a speed; a single block if the frequencies are static.
  subroutine write_frequencies(table, model, positions, sweep, threads)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: threads

    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: notes(:)
    integer :: i, k

    allocate (columns(2*model%modes + 2))
    columns(1) = real_column("speed", "rad/s")
    columns(2) = real_column("crank", "deg")
    do i = 1, model%modes
      columns(2 + i) = real_column("f"//to_string(i), "Hz")
      columns(2 + model%modes + i) = real_column("error"//to_string(i), "-")
    end do
    notes = effects_notes(model)
    call append_string(notes, &
      "error1 and so on: how far off each frequency may be, of itself: mesh and rounding")
    call write_header(table, model%title, notes, columns)
    do k = 1, size(sweep%request%speed)
      if (k > 1) call write_gap(table, 2)
      call write_block(table, positions, sweep, k, threads, sum(columns%width))
    end do
  end subroutine write_frequencies

  !> All rows of a speed. Their digits are worked out by all threads, a number of rows at a time,
  !! and written in order.
  subroutine write_block(table, positions, sweep, speed, threads, width)
    type(table_t), intent(inout) :: table
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: speed   !! number
    integer, intent(in) :: threads
    integer, intent(in) :: width   !! of a row

    character(len=width) :: rows(rows_at_once)
    integer :: i, first, last

    do first = 1, size(positions%crank), rows_at_once
      last = min(first + rows_at_once - 1, size(positions%crank))
      !$omp parallel do num_threads(threads) default(shared) private(i)
      do i = first, last
        if (has_result(positions, sweep, positions%state(i), speed)) then
          call fill_row(positions, sweep, i, speed, rows(i - first + 1))
        end if
      end do
      !$omp end parallel do
      do i = first, last
        if (has_result(positions, sweep, positions%state(i), speed)) then
          call write_row(table, rows(i - first + 1))
        else
          call write_failure(table, [sweep%request%speed(speed), positions%crank(i)], &
            failure_at(positions, sweep, positions%state(i), speed))
        end if
      end do
    end do
  end subroutine write_block

  subroutine fill_row(positions, sweep, row, speed, text)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: row, speed !! numbers
    character(len=*), intent(out) :: text

    associate (result => sweep%results(positions%state(row)))
      text = real_cells([sweep%request%speed(speed), positions%crank(row), &
        frequency_of(result%lambda(:, speed)), result%error(:, speed)])
    end associate
  end subroutine fill_row

  !> What the frequencies are, in words.
  pure function effects_notes(model) result(notes)
    type(model_t), intent(in) :: model
    type(string_t), allocatable :: notes(:)

    if (model%effects == effects_static) then
      call append_string(notes, &
        "static frequencies of the instantaneous structure; they do not depend on the speed")
    else if (.not. needs_loads(model)) then
      call append_string(notes, &
        "frequencies of the instantaneous structure at rest: no axial forces")
    else
      call append_string(notes, &
        "frequencies of the instantaneous structure with the axial forces of its "// &
        loads_in_words(model))
      call append_string(notes, acceleration_note(model))
      call append_string(notes, &
        "a negative frequency stands for sqrt(-lambda)/(2 pi) of a negative eigenvalue: static "// &
        "divergence")
    end if
    if (model%rotary .and. model%shear) then
      call append_string(notes, "links with rotary inertia and shear (Timoshenko)")
    else if (model%rotary) then
      call append_string(notes, "links with rotary inertia (Rayleigh)")
    else if (model%shear) then
      call append_string(notes, "links with shear")
    end if
  end function effects_notes

  !> `motion; lumped inertia`
  pure function loads_in_words(model) result(words)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: words

    words = "motion"
    if (is_loaded(model)) words = "motion and of constant loads"
    if (.not. is_moving(model)) words = "constant loads"
    if (model%inertia == inertia_lumped) words = words//"; lumped inertia"
    if (model%inertia == inertia_distributed) words = words//"; distributed inertia"
  end function loads_in_words

  !> Rows along every link of every mode; an empty line between links, two between modes.
  subroutine write_shapes(table, model, mechanism, positions, sweep)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep

    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: notes(:)
    type(unit_t) :: length, mass
    character(len=:), allocatable :: reason
    integer :: i, k, mode
    logical :: first

    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, integer_column("mode"))
    call append_column(columns, real_column("frequency", "Hz"))
    call append_column(columns, name_column("link", mechanism%names))
    call append_real_columns(columns, "s x y", length%name)
    call append_real_columns(columns, "ux uy", mass%name//"^-0.5")
    call append_column(columns, real_column("rotation", "rad."//mass%name//"^-0.5."//length%name// &
      "^-1"))
    notes = effects_notes(model)
    call append_string(notes, &
      "shapes are normalised: phi' M phi = 1; s runs along each link round the loop from "// &
      mechanism%pin_names(1)%text//" to "//mechanism%pin_names(4)%text)
    call write_header(table, model%title, notes, columns)
    first = .true.
    associate (report => model%reports(report_number(model, report_shapes)))
      do k = 1, size(sweep%request%speed)
        do i = 1, size(positions%crank)
          if (.not. is_drawn(report, positions%crank(i), sweep%request%speed(k))) cycle
          if (.not. first) call write_gap(table, 2)
          first = .false.
          reason = failure_at(positions, sweep, positions%state(i), k)
          if (len(reason) > 0) then
            call write_failure(table, [sweep%request%speed(k), positions%crank(i)], reason)
            cycle
          end if
          do mode = 1, model%modes
            if (mode > 1) call write_gap(table, 2)
            associate (state => positions%states(positions%state(i)), &
              result => sweep%results(positions%state(i)))
              call write_mode(table, mechanism, columns(5)%width, length, mass, state%pose, &
                result%shapes(k)%displacement(:, :, :, mode), [sweep%request%speed(k), &
                positions%crank(i)], mode, frequency_of(result%lambda(mode, k)))
            end associate
          end do
        end do
      end do
    end associate
  end subroutine write_shapes

  subroutine write_mode(table, mechanism, name_width, length, mass, pose, shape, place, mode, &
    frequency)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: name_width
    type(unit_t), intent(in) :: length, mass
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: shape(:, :, :) !! (x, y and rotation; points; bodies) [kg^-1/2]
    real(wp), intent(in) :: place(2)       !! speed and crank angle [rad/s, deg]
    integer, intent(in) :: mode
    real(wp), intent(in) :: frequency      !! [Hz]

    real(wp) :: s, displacement(3), scale
    integer :: body, i

    ! Displacements of a normalised mode have the unit mass^(-1/2).
    scale = sqrt(to_si(1.0_wp, mass))
    do body = 1, size(mechanism%names)
      associate (this => mechanism%linkage%bodies(body))
        if (body > 1) call write_gap(table, 1)
        do i = 1, size(shape, 2)
          s = this%length*(i - 1)/(size(shape, 2) - 1)
          displacement = scale*shape(:, i, body)
          displacement(3) = to_si(displacement(3), length)
          call write_row(table, real_cells(place)//integer_cell(mode, "mode")// &
            real_cells([frequency])//name_cell(mechanism%names(body)%text, name_width)// &
            real_cells([from_si([s, pose%pin(:, this%first_pin) + s*pose%direction(:, body)], &
            length), displacement]))
        end do
      end associate
    end do
  end subroutine write_mode

end module frequency_report
