import sys,time,json
import numpy as np, cma
from footfall.models.policy import stock_policy
from footfall.simulate.learn import stops as S
from footfall.simulate.walker.walkers import Walkers
import footfall.models.subject as subj
pol=stock_policy()
SL=[(0.057,0.057),(0.057,-0.057),(0.0,0.08),(0.0,-0.08),(0.08,0.0),(-.08,0.0),(.05,0.0),(0.035,0.035),(-0.057,0.057)]; PEOPLE=[4,4,3,3,4,3,4,2,2]
SLOPES=[s for s,k in zip(SL,PEOPLE) for _ in range(k)]; M=len(SLOPES)
cur={}
class Spy(Walkers):
    def step(self,a,force=None):
        if 'P' in cur: self._state['tune']=np.repeat(cur['P'],M,axis=0)
        t=super().step(a,force)
        al=self.velocity()[0]; stopping=(self.speed_goal<.2)&(self.gate.value>.5)
        cur['drift']=np.maximum(cur['drift'],np.where(stopping,-al,0)); cur['fell']|=self.fallen()
        return t
S.Walkers=Spy
real_draw=S.draw_subject
def run(P,seed):
    P=np.atleast_2d(P); n=len(P)*M
    cur['P']=P; cur['drift']=np.zeros(n); cur['fell']=np.zeros(n,bool)
    # the same people for every candidate
    base=[real_draw(np.random.default_rng([seed,7,i])) for i in range(M)]; it=iter(base*len(P)); S.draw_subject=lambda rng: next(it)
    S.attempt_stops(pol,seed=seed,people=1,threads=2,slopes=tuple(SLOPES*len(P)))
    fell=cur['fell'].reshape(len(P),M).sum(1); drift=np.clip(cur['drift']-.25,0,1).reshape(len(P),M).sum(1)
    return fell,drift
SC=np.array([.6,.6,.6,1.,.8,.5,.6,.8,.8,.8])
X0=.5*np.array([.5,.55,.1,.4,.8,-.4,.25,-.2,-.15,.15])
def main():
    t0=time.time(); minutes=float(sys.argv[1])
    es=cma.CMAEvolutionStrategy(X0/SC,0.3,{'popsize':10,'seed':4,'verbose':-9})
    g=0
    while time.time()-t0<60*minutes:
        Z=np.array(es.ask()); P=np.vstack([np.zeros(10),SC*es.mean,Z*SC]); fell,drift=run(P,300+g); g+=1
        cost=fell+.5*drift
        es.tell(list(Z),list(cost[2:])); json.dump((SC*es.mean).tolist(),open('tune_mean.json','w'))
        print('%.0fs'%(time.time()-t0),'base %d/%.1f mean %d/%.1f |'%(fell[0],drift[0],fell[1],drift[1]),' '.join('%d/%.1f'%x for x in zip(fell[2:],drift[2:])),'|',np.round(SC*es.mean,2),flush=True)
if __name__=='__main__': main()
