# Names and labels that a version has changed, old to new; tests/same_results applies them to what BEFORE wrote.
s/the arm is led through reach, grasp and lift, and a network learns by back-propagation to do it alone/the arm is guided through reach, grasp and lift, and a network learns by back-propagation to do it alone/
s/Lessons, each after [^;]* so far; the one thing/Iterations of training, each after an evaluation of what has been learned; the one thing/
s/Times that the arm is led in a lesson, each from another start/Demonstrations in an iteration, each from another start/
s/Times that all of them are gone through\./Epochs: how often an iteration learns from each of them./
s/Demonstrations of a step of learning\./Demonstrations in a gradient step./
s/Size of a step of learning, of Adam\./Learning rate of Adam./
s/Lessons after which the step has half that size, and a third/Iterations after which the rate is half, and a third/
s/Steps of learning over which the network is averaged before it [^;]*; 1:/Gradient steps over which the network is averaged; 1:/
s/Lessons until the network leads itself fully in a lesson's last demonstration, 0/Iterations until the network alone acts in the last demonstration of an iteration, 0/
s/as far as it can; lives in rapier, so/as far as it can; runs in rapier, so/
# The viewer of pages: a trial was a life. The key of the data is the format's and stays.
s/"lives":/"LIVESKEY":/g
s/\bpage\.lives\b/page.LIVESKEY/g
s/\blifeOf\b/trialOf/g
s/\bshowLives\b/showTrials/g
s/\blives\b/trials/g
s/\blife\b/trial/g
s/\bLife\b/Trial/g
s/LIVESKEY/lives/g
s/What is wanted of a whole trial, once\./Once for each trial./
s/are told by colour, others/are shown by colour, others/
s/of what tells them apart/of what differs/
s/wheels that do exactly what they are told/wheels that do exactly what is commanded/
s/enough for what the results tell, in minutes/enough for what the results show, in minutes/
s/Who shares the displacements; shared by/Which individuals share the displacements; shared by/
