# Which rows of motion.dat are pictures of its animation; after style.gp and `eval answer(table, "facts")`:
#   call "motion_pictures.gp"
# Sets pictures, their number, every_row, the rows from one to the next, delay, in hundredths of a second, and slower, how many times
# slower than the motion they are shown. Rows are at equal steps, time_step; there are 25 pictures in a second or fewer.

second = unit_time eq "ms" ? 1000.0 : 1.0           # of the deck's unit of time
length = (high_time - low_time)/second
time_step = rows > 1 ? (high_time - low_time)/(rows - 1.0) : 1
slower = length < 1.5 && length > 0 ? nice(2/length) : 1
step = rows > 1 ? slower*length/(rows - 1) : 1
every_row = step < 0.04 ? int(floor(0.04/step + 0.001)) : 1
pictures = (rows - 1)/every_row + 1
if (pictures > 150) { pictures = 150 }
hundredths = every_row*step*100
delay = hundredths < 2 ? 2 : floor(hundredths + 0.5)
